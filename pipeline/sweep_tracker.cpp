#include "pipeline/sweep_tracker.h"

#include <algorithm>

namespace octascope::pipeline {

hal::TimePoint SweepTracker::armed(std::uint64_t volume, hal::TimePoint when) {
  const Start& last = recent_.front();
  const hal::TimePoint start = last.volume == 0 ? when : std::max(when, last.when + duration_);
  std::rotate(recent_.begin(), recent_.end() - 1, recent_.end());
  recent_.front() = {volume, start};
  return start + duration_;
}

std::optional<SweepSlot> SweepTracker::place(hal::TimePoint first_line) {
  for (Start& start : recent_) {
    const hal::Duration since_start = first_line - start.when;
    if (start.volume == 0 || since_start < -period_ / 2)
      continue;
    const auto sweep = (since_start + period_ / 2) / period_;
    if (sweep >= sweeps_)
      return std::nullopt;
    const hal::Duration deviation = since_start - sweep * period_;
    start.when += deviation / 4;
    return SweepSlot{start.volume, static_cast<int>(sweep)};
  }
  return std::nullopt;
}

} // namespace octascope::pipeline
