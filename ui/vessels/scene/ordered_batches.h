// Numbered batches of drawing work, submitted to GL in order and expanded by whichever thread is
// free.
#pragma once

#include <atomic>
#include <cstdint>
#include <vector>

#include "pipeline/threads/wakeup.h"
#include "pipeline/threads/worker_pool.h"

namespace octascope::ui {

// The calling thread owns GL and takes one batch after the other from the cursor. A helper works
// ahead of it: it takes the first free batch some distance in front of the cursor and expands it
// into a slot, so that it is ready when the cursor arrives. The distance is learnt: it grows each
// time the cursor had to wait. At equal depths the first drawn wins, so the order in which batches
// reach GL must not depend on timing.
//
// A batch is claimed by one atomic operation. The caller never waits for a helper that has not
// begun.
//
// Threads: run() from one thread at a time. Allocates only when made.
class OrderedBatches {
public:
  static constexpr std::uint32_t most_batches = 16384;

  // The helper uses the slots 0 to slots − 1 in turn. Its role is "vessels".
  OrderedBatches(std::uint32_t slots, const pipeline::ThreadSetup& setup);

  // For each batch (at most most_batches) in order, on this thread: either own(batch), or
  // submit(batch, slot) of what the helper has expanded with expand(batch, slot) on its own thread.
  // A slot is in use from the beginning of expand() until submit() has returned.
  template <class Own, class Expand, class Submit>
  void run(std::uint32_t batches, const Own& own, const Expand& expand, const Submit& submit) {
    begin(
        batches,
        [](const void* e, std::uint32_t batch, std::uint32_t slot) {
          (*static_cast<const Expand*>(e))(batch, slot);
        },
        &expand);
    for (std::uint32_t batch = 0; batch < batches; ++batch)
      if (claim(batch)) {
        own(batch);
      } else {
        submit(batch, await(batch));
        release();
      }
    end();
  }

private:
  enum class State : std::uint8_t { free, callers, helpers, ready };
  static constexpr std::uint64_t stamped(std::uint32_t turn, State state, std::uint32_t slot = 0) {
    return std::uint64_t{turn} << 32U | std::uint64_t{slot} << 8U |
           static_cast<std::uint64_t>(state);
  }
  using Expand = void (*)(const void* work, std::uint32_t batch, std::uint32_t slot);

  void begin(std::uint32_t batches, Expand expand, const void* work);
  bool claim(std::uint32_t batch); // for the caller
  std::uint32_t await(std::uint32_t batch);
  void release();
  void end();
  void help(std::uint32_t turn);
  bool await_slot(std::uint32_t turn);

  std::uint32_t slots_;
  std::vector<std::atomic<std::uint64_t>> claims_; // by batch: turn, slot, state
  std::atomic<std::uint32_t> turn_{0};             // 0 while none runs
  std::uint32_t turns_ = 0;
  // Read only by the owner of a claimed batch: the turn cannot end before that is submitted.
  Expand expand_ = nullptr;
  const void* work_ = nullptr;
  std::atomic<std::uint32_t> cursor_{0};
  std::atomic<std::uint32_t> lead_{2};     // batches in front of the cursor
  std::uint32_t in_time_ = 0;              // batches since one had to be waited for
  std::uint32_t filled_ = 0;               // slots filled by the helper so far
  std::atomic<std::uint32_t> released_{0}; // slots released by the caller so far
  pipeline::Wakeup slot_released_;
  pipeline::Wakeup batch_ready_;
  pipeline::WorkerPool helper_; // last: its thread stops before the other members are destroyed
};

} // namespace octascope::ui
