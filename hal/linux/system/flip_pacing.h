// When a flip was completed and when the next picture may follow. Pure: times in, times out.
#pragma once

#include <optional>

#include "hal/clock.h"

namespace octascope::hal::linux_backend {

// What is known of one flip.
struct FlipTimes {
  TimePoint submitted;            // handed to the kernel
  std::optional<TimePoint> stamp; // of its event, by the driver; none where it cannot tell
  TimePoint received;             // when its event was read
};

// Real outputs flip once a refresh and stamp it. Virtual ones may flip at once, late, or with a
// stamp of their own making: then the clock paces.
class FlipPacer {
public:
  FlipPacer() = default;
  // `shown`: when the first picture came with the mode.
  FlipPacer(Duration period, TimePoint shown)
      : period_{period}, completed_{shown}, next_allowed_{shown} {}

  // When the flip reached the glass: the driver's stamp where it can be true (the start of scan-out
  // may lie a little ahead of the event), else when the event came. Never before the one before.
  TimePoint completed(const FlipTimes& flip);

  // Wait until then before the next picture: in the past for an output that paces itself, one
  // period after the last time for one that flips at once.
  TimePoint next_allowed() const { return next_allowed_; }

private:
  Duration period_{};
  TimePoint completed_;
  TimePoint next_allowed_;
};

} // namespace octascope::hal::linux_backend
