// When this process started, on the clock's axis.
#pragma once

#include "hal/clock.h"

namespace octascope::firmware_host {

// As recorded by the kernel, to a hundredth of a second: before the loader ran. If unknown, now.
// The clock must be on CLOCK_MONOTONIC's axis.
hal::TimePoint process_start(const hal::Clock& clock);

} // namespace octascope::firmware_host
