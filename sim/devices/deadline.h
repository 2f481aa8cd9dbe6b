// Deadlines for waits with a timeout from the caller.
#pragma once

#include <algorithm>

#include "hal/clock.h"

namespace octascope::sim {

// now + timeout, without overflow for timeouts that mean "for ever".
inline hal::TimePoint deadline_after(hal::TimePoint now, hal::Duration timeout) {
  return now + std::clamp<hal::Duration>(timeout, hal::Duration{}, std::chrono::years{1});
}

} // namespace octascope::sim
