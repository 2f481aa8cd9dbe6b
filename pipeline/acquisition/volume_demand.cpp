#include "pipeline/acquisition/volume_demand.h"

#include <algorithm>

namespace octascope::pipeline {

// Whatever else the renderer drew meanwhile belongs to the time that a volume takes.
void VolumeDemand::taken(hal::TimePoint published) {
  busy_since_.store(std::max(published, last_drawn_), std::memory_order_relaxed);
}

void VolumeDemand::drawn(hal::TimePoint now) {
  last_drawn_ = now;
  const hal::TimePoint since = busy_since_.exchange(idle, std::memory_order_relaxed);
  if (since == idle)
    return;
  lately_[oldest_] = now - since;
  oldest_ = (oldest_ + 1) % lately_.size();
  auto sorted = lately_;
  const auto two_thirds = sorted.begin() + sorted.size() * 2 / 3;
  std::ranges::nth_element(sorted, two_thirds);
  drawing_.store(*two_thirds, std::memory_order_relaxed);
}

// A renderer that is overdue lacks the cores: it is given half as long again as it has been at it.
bool VolumeDemand::would_be_seen(hal::TimePoint pulsed, hal::Duration period,
                                 bool another_waits) const {
  const hal::Duration drawing = drawing_.load(std::memory_order_relaxed);
  const hal::TimePoint since = busy_since_.load(std::memory_order_relaxed);
  hal::TimePoint free = pulsed;
  if (since != idle)
    free = std::max(since + drawing, pulsed + (pulsed - since) / 2);
  if (another_waits)
    free += drawing;
  return free <= pulsed + 3 * period / 2;
}

} // namespace octascope::pipeline
