#include "sim/devices/galvo_link.h"

namespace octascope::sim {

using hal::TimePoint;

PulseFate GalvoLink::pulse(TimePoint rising_edge) {
  const std::uint64_t index = sweeps_.load(std::memory_order_relaxed);
  TimePoint start = rising_edge;
  PulseFate fate = PulseFate::started;
  if (index > 0 && rising_edge < newest_start_ + sweep_duration_) {
    if (newest_start_ > rising_edge) { // the newest sweep is itself still latched
      lost_pulses_.fetch_add(1, std::memory_order_relaxed);
      return PulseFate::lost;
    }
    start = newest_start_ + sweep_duration_;
    fate = PulseFate::latched;
  }
  newest_start_ = start;
  starts_ns_[index % memory].store(start.time_since_epoch().count(), std::memory_order_release);
  sweeps_.store(index + 1, std::memory_order_release);
  return fate;
}

std::optional<TimePoint> GalvoLink::start_of(std::uint64_t index) const {
  if (index >= sweeps())
    return std::nullopt;
  const std::int64_t start_ns = starts_ns_[index % memory].load(std::memory_order_acquire);
  // Whoever sees the start of a later sweep in this place also sees that there are so many.
  if (sweeps() - index >= memory)
    return std::nullopt;
  return TimePoint{hal::Duration{start_ns}};
}

} // namespace octascope::sim
