#include "hal/linux/aravis/camera_clock.h"

#include <algorithm>

namespace octascope::hal::linux_backend {

using namespace std::chrono_literals;

TimePoint CameraClock::end_of_frame(std::uint64_t stamp_ns, TimePoint arrival) {
  constexpr std::uint64_t most_ns = 1ULL << 62; // 146 years, and far from an overflow
  if (stamp_ns == 0 || stamp_ns > most_ns || stamp_ns <= last_stamp_ns_) {
    distance_.reset();
    last_stamp_ns_ = 0;
    return arrival;
  }
  const Duration stamp{static_cast<Duration::rep>(stamp_ns)};
  const Duration delayed = arrival.time_since_epoch() - stamp;
  if (distance_) {
    const auto passed = static_cast<double>(stamp_ns - last_stamp_ns_);
    const Duration grown = *distance_ + Duration{static_cast<Duration::rep>(passed * most_drift)};
    const bool jumped = delayed - grown > 1s || grown - delayed > 1s;
    distance_ = jumped ? delayed : std::min(grown, delayed);
  } else {
    distance_ = delayed;
  }
  last_stamp_ns_ = stamp_ns;
  return std::min(TimePoint{stamp + *distance_}, arrival);
}

} // namespace octascope::hal::linux_backend
