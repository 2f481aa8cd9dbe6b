// When a flip was completed and when the next image may follow. Pure: times in, times out.
#pragma once

#include <optional>

#include "hal/clock.h"

namespace octascope::hal::linux_backend {

// What is known about one flip.
struct FlipTimes {
  TimePoint submitted;            // handed to the kernel
  std::optional<TimePoint> stamp; // the driver's, from its event; empty if it has none
  TimePoint received;             // when its event was read
  bool mode_set = false;          // it came with the mode, not with a refresh
};

// Real outputs flip once per refresh, with a correct time stamp. Virtual ones may flip immediately,
// late, or with a wrong time stamp: then the clock paces the images.
class FlipPacer {
public:
  FlipPacer() = default;
  // `shown`: when the mode was set, with the first image.
  FlipPacer(Duration period, TimePoint shown)
      : period_{period}, completed_{shown}, next_allowed_{shown} {}

  // When the flip became visible: the driver's time stamp if it is plausible (the start of scan-out
  // may be a little after the event), else when the event was read. Never decreases.
  TimePoint completed(const FlipTimes& flip);

  // When the next image may be drawn: not in the future for an output that paces itself, one period
  // after the last one for an output that flips immediately.
  TimePoint next_allowed() const { return next_allowed_; }

  // When the next image can become visible, for an output that paces itself; else empty.
  std::optional<TimePoint> next_refresh() const;

private:
  Duration period_{};
  TimePoint completed_;
  TimePoint next_allowed_;
  bool paces_itself_ = false; // as far as the last flip told
};

} // namespace octascope::hal::linux_backend
