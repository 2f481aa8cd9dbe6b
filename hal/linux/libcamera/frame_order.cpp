#include "hal/linux/libcamera/frame_order.h"

#include <algorithm>

namespace octascope::hal::linux_backend {

namespace {

// No picture is older when it arrives; a time further back is one of another clock.
constexpr Duration oldest = std::chrono::seconds{2};

bool believable(TimePoint time, TimePoint arrival) {
  return time <= arrival && time > arrival - oldest;
}

// Before the exposure of a frame that was made 2^31 frames later: the driver began anew.
constexpr std::uint32_t half_way = std::uint32_t{1} << 31;

} // namespace

FrameOrder::Place FrameOrder::place(const RequestStamp& stamp, TimePoint arrival) {
  if (driver_sequence_) {
    const std::uint32_t step = stamp.sequence - *driver_sequence_;
    sequence_ += step == 0 || step >= half_way ? 1 : step;
  }
  driver_sequence_ = stamp.sequence;

  TimePoint time = arrival;
  if (const TimePoint exposed{Duration{stamp.exposed_ns.value_or(0)}}; believable(exposed, arrival))
    time = exposed;
  else if (const TimePoint filled{Duration{static_cast<std::int64_t>(stamp.filled_ns)}};
           believable(filled, arrival))
    time = filled;
  if (last_time_)
    time = std::min(std::max(time, *last_time_ + Duration{1}), arrival);
  last_time_ = time;
  return {sequence_, time};
}

} // namespace octascope::hal::linux_backend
