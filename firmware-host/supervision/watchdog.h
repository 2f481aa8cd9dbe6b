// When systemd's watchdog is kicked: only when the picture has proved itself since the last time.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/clock.h"

namespace octascope::firmware_host {

// How long systemd shall wait for a kick until a machine has settled: its first pictures of a
// volume make the graphics driver compile, for tens of seconds where the processor is slow or
// emulated. A restart would only begin that anew.
inline constexpr hal::Duration patience_before_settled = std::chrono::seconds{60};

// Pure but for what it remembers.
class Watchdog {
public:
  // `interval` is the unit's WatchdogSec; empty: nobody watches, and nothing is ever due.
  explicit Watchdog(std::optional<hal::Duration> interval) : interval_{interval} {}

  // Is a kick due, with PictureProof's steps as they are now? Four times an interval at most.
  bool due(std::uint64_t steps, hal::TimePoint now) {
    if (!interval_ || steps == steps_ || now < next_)
      return false;
    steps_ = steps;
    next_ = now + *interval_ / 4;
    return true;
  }

  // With PictureProof's frames that showed a volume, as they are now. True once: these have come
  // for a whole interval, without a pause of half of it.
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
