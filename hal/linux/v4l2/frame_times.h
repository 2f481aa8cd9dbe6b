// When a frame's first and last lines were exposed, from what the driver stamped. Pure.
//
// V4L2 stamps a frame with its end (the last pixel received) or with the start of its exposure, on
// the monotonic clock or on one that it does not name (kernel documentation, "Buffer Flags").
#pragma once

#include <cstdint>

#include "hal/clock.h"

namespace octascope::hal::linux_backend {

struct FrameStamp {
  enum class Clock : std::uint8_t { monotonic, unnamed, foreign } clock = Clock::monotonic;
  enum class Moment : std::uint8_t { end, start_of_exposure } moment = Moment::end;
  std::int64_t seconds = 0;
  std::int64_t microseconds = 0;
};

struct ExposureTimes {
  TimePoint first_line;
  TimePoint last_line;
  bool own_clock = false; // the stamp was of no use: `now` was taken for the frame's end
};

// True where the wall clock is far enough from the monotonic one for a stamp to tell which of both
// it was made with; not so on a machine without a real-time clock that has just started.
bool tells_clocks_apart(TimePoint monotonic, Duration wall_clock_since_1970);

// `now`: when the frame was fetched. A stamp is taken when it lies on the monotonic clock: it says
// so, or, of an unnamed clock, it is at most 2 s old and `clocks_differ`. One that cannot be right
// (after `now`, by more than drivers are known to stamp ahead, or a minute old) is not taken.
// No line is later than `now`.
ExposureTimes exposure_times(const FrameStamp& stamp, TimePoint now, bool clocks_differ, int lines,
                             double line_rate_hz);

} // namespace octascope::hal::linux_backend
