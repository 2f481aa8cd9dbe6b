#include "pipeline/acquisition/volume_demand.h"

#include <algorithm>

namespace octascope::pipeline {

// Whatever else the renderer drew meanwhile belongs to the time that a volume takes.
void VolumeDemand::taken(hal::TimePoint published) {
  busy_since_.store(std::max(published, last_drawn_.load(std::memory_order_relaxed)),
                    std::memory_order_relaxed);
}

void VolumeDemand::begun(hal::TimePoint now) {
  if (busy_since_.load(std::memory_order_relaxed) == idle)
    busy_since_.store(now, std::memory_order_relaxed);
}

void VolumeDemand::drawn(hal::TimePoint now) {
  last_drawn_.store(now, std::memory_order_relaxed);
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

// It comes next to what waits for it. One that is overdue lacks the cores: it is given half as long again as
// it has been at it.
hal::TimePoint VolumeDemand::likely_free(hal::TimePoint now,
                                         std::optional<hal::TimePoint> waits_since) const {
  const hal::Duration drawing = drawing_.load(std::memory_order_relaxed);
  const hal::TimePoint busy = busy_since_.load(std::memory_order_relaxed);
  if (busy == idle && !waits_since)
    return now;
  const hal::TimePoint since =
      busy != idle ? busy : std::max(*waits_since, last_drawn_.load(std::memory_order_relaxed));
  const hal::TimePoint free = std::max(since + drawing, now + (now - since) / 2);
  return busy != idle && waits_since ? free + drawing : free;
}

// Of a volume that rolls the first B-scans are seen before it is built; a whole one replaces what waits.
bool VolumeDemand::would_be_seen(hal::TimePoint pulsed, hal::Duration period,
                                 std::optional<hal::TimePoint> waits_since,
                                 bool another_is_built) const {
  const hal::TimePoint free = likely_free(pulsed, waits_since);
  if (expected() == Showing::rolling)
    return free <= pulsed + period;
  if (waits_since && another_is_built)
    return false;
  const hal::Duration for_another =
      another_is_built ? drawing_.load(std::memory_order_relaxed) : hal::Duration{};
  return free + for_another <= pulsed + 3 * period / 2;
}

} // namespace octascope::pipeline
