// Numbered pieces of one piece of work, shared between the calling thread and some helpers.
#pragma once

#include <atomic>
#include <cstdint>

#include "pipeline/threads/wakeup.h"
#include "pipeline/threads/worker_pool.h"

namespace octascope::ui {

// The calling thread takes pieces like the others and never waits for a helper that has not begun:
// one that wakes late finds nothing left and goes back to sleep.
//
// Threads: run() from one thread at a time. Allocates when it is made, never afterwards.
class WorkTeam {
public:
  // `helpers` threads are started besides the one that will call run(); 0 is good. Their role is
  // "rays".
  WorkTeam(std::size_t helpers, const pipeline::ThreadSetup& setup);

  std::size_t helpers() const { return helpers_.workers(); }

  // Calls work(i) for each i < pieces, on any of the threads, and returns when all are done.
  template <class Work> void run(std::uint32_t pieces, const Work& work) {
    run(
        pieces, [](const void* w, std::uint32_t i) { (*static_cast<const Work*>(w))(i); }, &work);
  }

private:
  using Call = void (*)(const void* work, std::uint32_t piece);

  void run(std::uint32_t pieces, Call call, const void* work);
  void take_pieces(std::uint32_t turn);

  // Read only by who has claimed a piece: the turn cannot end before that is finished.
  Call call_ = nullptr;
  const void* work_ = nullptr;
  std::uint32_t pieces_ = 0;
  std::atomic<std::uint64_t> claims_{0}; // the turn's number in the upper half, pieces left below
  std::atomic<std::uint32_t> finished_{0};
  pipeline::Wakeup all_finished_;
  pipeline::WorkerPool helpers_; // last: its threads stop before the rest is gone
};

// By the team; where there is none, by the caller alone.
template <class Work> void run_pieces(WorkTeam* team, std::uint32_t pieces, const Work& work) {
  if (team != nullptr)
    return team->run(pieces, work);
  for (std::uint32_t i = 0; i < pieces; ++i)
    work(i);
}

} // namespace octascope::ui
