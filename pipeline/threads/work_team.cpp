#include "pipeline/threads/work_team.h"

#include <algorithm>

namespace octascope::ui {

namespace {
// So many calls can wait for helpers that were held up; more are not needed, for each of them works
// on until nothing is left.
constexpr std::size_t most_calls = 64;

// The pool's threads are "worker"s, which is the role of those that reconstruct.
pipeline::ThreadSetup as_rays(const pipeline::ThreadSetup& setup) {
  if (!setup)
    return {};
  return [setup](pipeline::ThreadRole role) { setup({"rays", role.number}); };
}

} // namespace

WorkTeam::WorkTeam(std::size_t helpers, const pipeline::ThreadSetup& setup)
    : helpers_{helpers, most_calls, as_rays(setup),
               [this](std::size_t, std::uint32_t turn) { take_pieces(turn); }} {}

void WorkTeam::run(std::uint32_t pieces, Call call, const void* work) {
  if (pieces == 0)
    return;
  const auto turn = static_cast<std::uint32_t>(claims_.load(std::memory_order_relaxed) >> 32U) + 1;
  call_ = call;
  work_ = work;
  pieces_ = pieces;
  finished_.store(0, std::memory_order_relaxed);
  claims_.store((std::uint64_t{turn} << 32U) | pieces, std::memory_order_release);
  for (std::size_t i = 0; i < std::min<std::size_t>(helpers_.workers(), pieces - 1); ++i)
    helpers_.submit(turn);
  take_pieces(turn);
  all_finished_.wait();
}

void WorkTeam::take_pieces(std::uint32_t turn) {
  std::uint64_t claim = claims_.load(std::memory_order_acquire);
  while (static_cast<std::uint32_t>(claim >> 32U) == turn &&
         static_cast<std::uint32_t>(claim) > 0) {
    if (!claims_.compare_exchange_weak(claim, claim - 1, std::memory_order_acq_rel,
                                       std::memory_order_acquire))
      continue;
    const std::uint32_t pieces = pieces_; // once this piece is finished, the next turn may begin
    call_(work_, pieces - static_cast<std::uint32_t>(claim));
    if (finished_.fetch_add(1, std::memory_order_acq_rel) + 1 == pieces) {
      all_finished_.post();
      return;
    }
    claim = claims_.load(std::memory_order_acquire);
  }
}

} // namespace octascope::ui
