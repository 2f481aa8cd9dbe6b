#include "pipeline/sweep_tracker.h"

#include <algorithm>

namespace octascope::pipeline {

hal::TimePoint SweepTracker::armed(std::uint64_t volume, hal::TimePoint when) {
  const Sweep& last = recent_.front();
  const hal::TimePoint start = last.volume == 0 ? when : std::max(when, last.start + duration_);
  std::rotate(recent_.begin(), recent_.end() - 1, recent_.end());
  recent_.front() = {volume, start};
  return start + duration_;
}

std::optional<SweepSlot> SweepTracker::place(hal::TimePoint first_line) {
  for (Sweep& sweep : recent_) {
    const hal::Duration since_start = first_line - sweep.start;
    if (sweep.volume == 0 || since_start < -period_ / 2)
      continue;
    const auto b_scan = (since_start + period_ / 2) / period_;
    if (b_scan >= b_scans_)
      return std::nullopt;
    const hal::Duration deviation = since_start - b_scan * period_;
    sweep.start += deviation / 4;
    return SweepSlot{sweep.volume, static_cast<int>(b_scan)};
  }
  return std::nullopt;
}

} // namespace octascope::pipeline
