// Sequence numbers and times that rise, from what drivers say. Pure.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/clock.h"

namespace octascope::hal::linux_backend {

// What is known of a frame when it arrives. Times in ns since the machine's start; 0 or empty where
// the driver gives none.
struct FrameStamp {
  std::uint32_t sequence = 0;
  std::optional<std::int64_t> exposed_ns; // by the sensor
  std::uint64_t filled_ns = 0;            // by the driver that filled the buffer
};

// One stream. The driver's sequence wraps at 32 bits, may start anywhere and, in some drivers,
// stands still; times may be those of another clock (libcamera's sensor time goes by
// CLOCK_BOOTTIME, which runs ahead of CLOCK_MONOTONIC after the machine has slept).
class FrameOrder {
public:
  struct Place {
    std::uint64_t sequence; // from 0, gaps are lost frames
    TimePoint time;         // rising, never after `arrival`
  };
  Place place(const FrameStamp& stamp, TimePoint arrival);

private:
  std::optional<std::uint32_t> driver_sequence_;
  std::uint64_t sequence_ = 0;
  std::optional<TimePoint> last_time_;
};

} // namespace octascope::hal::linux_backend
