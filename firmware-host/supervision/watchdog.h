// When systemd's watchdog is kicked: only if the picture has proved itself since the last kick.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/clock.h"

namespace octascope::firmware_host {

// How long systemd waits for a kick until the machine has settled: the first pictures of a volume
// make the graphics driver compile, for tens of seconds on a slow or emulated processor. A restart
// would only begin that anew.
inline constexpr hal::Duration patience_before_settled = std::chrono::seconds{60};

// Pure but for its own state.
class Watchdog {
public:
  // `interval` is the unit's WatchdogSec; empty: no watchdog, nothing is ever due.
  explicit Watchdog(std::optional<hal::Duration> interval) : interval_{interval} {}

  // Whether a kick is due, given PictureProof's steps now. At most four times an interval.
  bool due(std::uint64_t steps, hal::TimePoint now) {
    if (!interval_ || steps == steps_ || now < next_)
      return false;
    steps_ = steps;
    next_ = now + *interval_ / 4;
    return true;
  }

  // Given PictureProof's frames that showed a volume. True once: when these have come for a whole
  // interval without a pause of half of it.
  bool settles(std::uint64_t volume_frames, hal::TimePoint now) {
    if (!interval_ || settled_ || volume_frames == volume_frames_)
      return false;
    if (volume_frames_ == 0 || now - last_volume_ > *interval_ / 2)
      steady_since_ = now;
    volume_frames_ = volume_frames;
    last_volume_ = now;
    settled_ = now - steady_since_ >= *interval_;
    return settled_;
  }

private:
  std::optional<hal::Duration> interval_;
  std::uint64_t steps_ = 0; // at the last kick
  hal::TimePoint next_;     // not before
  bool settled_ = false;
  std::uint64_t volume_frames_ = 0;
  hal::TimePoint last_volume_, steady_since_;
};

} // namespace octascope::firmware_host
