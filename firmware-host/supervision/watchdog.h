// When systemd's watchdog is kicked: only when the picture has proved itself since the last time.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/clock.h"

namespace octascope::firmware_host {

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

private:
  std::optional<hal::Duration> interval_;
  std::uint64_t steps_ = 0; // at the last kick
  hal::TimePoint next_;     // not before
};

} // namespace octascope::firmware_host
