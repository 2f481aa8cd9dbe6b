// When this process was started, on the clock's axis.
#pragma once

#include "hal/clock.h"

namespace octascope::firmware_host {

// As the kernel noted it: before the loader, to a hundredth of a second. Where the kernel does not
// say, now. The clock's axis is CLOCK_MONOTONIC's.
hal::TimePoint process_start(const hal::Clock& clock);

} // namespace octascope::firmware_host
