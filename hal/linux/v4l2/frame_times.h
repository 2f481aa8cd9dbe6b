// The exposure times of a frame's first and last lines, from the driver's time stamp. Pure.
//
// A V4L2 time stamp is of a frame's end (the last pixel received) or of the start of its exposure,
// on the monotonic clock or an unspecified one (kernel documentation, "Buffer Flags").
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
  bool own_clock = false; // the stamp was unusable: `now` was taken as the frame's end
};

// Whether the wall clock and the monotonic clock differ enough to tell from a stamp which one it is
// of. They do not on a machine without a real-time clock that has just booted.
bool tells_clocks_apart(TimePoint monotonic, Duration wall_clock_since_1970);

// `now`: when the frame was fetched. A stamp is used if it is of the monotonic clock and plausible:
// at most 100 ms ahead of `now`, as some drivers stamp, and at most a minute old. A stamp of an
// unnamed clock is taken as monotonic if `clocks_differ` and it is at most 2 s old. No line is
// later than `now`.
ExposureTimes exposure_times(const FrameStamp& stamp, TimePoint now, bool clocks_differ, int lines,
                             double line_rate_hz);

} // namespace octascope::hal::linux_backend
