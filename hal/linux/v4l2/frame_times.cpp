#include "hal/linux/v4l2/frame_times.h"

#include <algorithm>
#include <optional>

namespace octascope::hal::linux_backend {

using namespace std::chrono_literals;

namespace {

constexpr Duration most_ahead = 100ms; // vivid stamps a frame's end while it makes the frame
constexpr Duration oldest_monotonic = 60s;
constexpr Duration oldest_unnamed = 2s;

// Nothing where it would not fit, or is no time.
std::optional<TimePoint> time_of(const FrameStamp& stamp) {
  constexpr std::int64_t most_seconds = 4'000'000'000; // a century, and far from an overflow
  if (stamp.seconds < 0 || stamp.seconds > most_seconds || stamp.microseconds < 0 ||
      stamp.microseconds >= 1'000'000)
    return std::nullopt;
  return TimePoint{std::chrono::seconds{stamp.seconds} +
                   std::chrono::microseconds{stamp.microseconds}};
}

bool usable(const FrameStamp& stamp, TimePoint when, TimePoint now, bool clocks_differ) {
  const Duration age = now - when;
  switch (stamp.clock) {
  case FrameStamp::Clock::monotonic: return age >= -most_ahead && age <= oldest_monotonic;
  case FrameStamp::Clock::unnamed:
    return clocks_differ && age >= -most_ahead && age <= oldest_unnamed;
  case FrameStamp::Clock::foreign: return false;
  }
  return false;
}

} // namespace

bool tells_clocks_apart(TimePoint monotonic, Duration wall_clock_since_1970) {
  const Duration between = wall_clock_since_1970 - monotonic.time_since_epoch();
  return between > 10 * oldest_unnamed || between < -10 * oldest_unnamed;
}

ExposureTimes exposure_times(const FrameStamp& stamp, TimePoint now, bool clocks_differ, int lines,
                             double line_rate_hz) {
  const Duration whole = from_seconds(lines / line_rate_hz);
  const Duration to_last = from_seconds((lines - 1) / line_rate_hz);
  const auto when = time_of(stamp);
  if (!when || !usable(stamp, *when, now, clocks_differ))
    return {now - whole, now - whole + to_last, true};
  // The frame is there, so its end is not after now, nor its start later than a frame before.
  const TimePoint start =
      stamp.moment == FrameStamp::Moment::start_of_exposure ? *when : std::min(*when, now) - whole;
  const TimePoint first = std::min(start, now - to_last);
  return {first, first + to_last, false};
}

} // namespace octascope::hal::linux_backend
