// Deadlines of waits with a timeout chosen by the caller.
#pragma once

#include <algorithm>

#include "hal/clock.h"

namespace octascope::sim {

// now + timeout, without overflow for a timeout that means "for ever".
inline hal::TimePoint deadline_after(hal::TimePoint now, hal::Duration timeout) {
  return now + std::clamp<hal::Duration>(timeout, hal::Duration{}, std::chrono::years{1});
}

} // namespace octascope::sim
