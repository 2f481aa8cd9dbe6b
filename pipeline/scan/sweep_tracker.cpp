#include "pipeline/scan/sweep_tracker.h"

#include <algorithm>

namespace octascope::pipeline {

hal::TimePoint SweepTracker::pulsed(std::uint64_t volume, hal::TimePoint when) {
  const Start& last = recent_.front();
  const hal::TimePoint start = last.volume == 0 ? when : std::max(when, last.when + duration_);
  std::rotate(recent_.begin(), recent_.end() - 1, recent_.end());
  recent_.front() = {.volume = volume, .when = start, .pulse = when};
  return start + duration_;
}

// No frame of the volume before has come: either all were lost, and this pulse was latched until
// their end, or the scanner missed the pulse before, and this one started it at once.
void SweepTracker::reconsider_latch(Start& start, const Start& before,
                                    hal::TimePoint first_line) const {
  if (start.answered || before.volume == 0 || before.answered ||
      first_line < start.pulse - period_ / 2)
    return;
  const auto misfit = [&](hal::TimePoint begin) {
    const hal::Duration rest = std::chrono::abs(first_line - begin) % period_;
    return std::min(rest, period_ - rest);
  };
  if (misfit(start.pulse) < misfit(start.when))
    start.when = start.pulse;
}

std::optional<SweepSlot> SweepTracker::place(hal::TimePoint first_line) {
  for (std::size_t i = 0; i < recent_.size(); ++i) {
    Start& start = recent_[i];
    if (i + 1 < recent_.size())
      reconsider_latch(start, recent_[i + 1], first_line);
    const hal::Duration since_start = first_line - start.when;
    if (start.volume == 0 || since_start < -period_ / 2)
      continue;
    const auto sweep = (since_start + period_ / 2) / period_;
    if (sweep >= sweeps_)
      return std::nullopt;
    const hal::Duration deviation = since_start - sweep * period_;
    start.when += deviation / 4;
    start.answered = true;
    return SweepSlot{start.volume, static_cast<int>(sweep)};
  }
  return std::nullopt;
}

} // namespace octascope::pipeline
