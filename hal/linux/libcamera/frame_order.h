// Makes increasing sequence numbers and times from those of the driver. Pure.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/clock.h"

namespace octascope::hal::linux_backend {

// What is known about a frame when it arrives. Times are in ns since boot; 0 or empty if the driver
// gives none.
struct RequestStamp {
  std::uint32_t sequence = 0;
  std::optional<std::int64_t> exposed_ns; // by the sensor
  std::uint64_t filled_ns = 0;            // by the driver that filled the buffer
};

// For one stream. The driver's sequence wraps at 32 bits, may start anywhere and, with some
// drivers, never changes. Its times may be of another clock: libcamera's sensor times are of
// CLOCK_BOOTTIME, which is ahead of CLOCK_MONOTONIC after the machine was suspended.
class FrameOrder {
public:
  struct Place {
    std::uint64_t sequence; // starts at 0; gaps are lost frames
    TimePoint time;         // increases, but is never after `arrival`
  };
  Place place(const RequestStamp& stamp, TimePoint arrival);

private:
  std::optional<std::uint32_t> driver_sequence_;
  std::uint64_t sequence_ = 0;
  std::optional<TimePoint> last_time_;
};

} // namespace octascope::hal::linux_backend
