// Name and priority of each thread, by its role.
#pragma once

#include "hal/clock.h"
#include "pipeline/fault_log.h"
#include "pipeline/worker_pool.h"

namespace octascope::firmware_host {

// What the pipeline's threads call first. Camera and volume threads come before the workers, the
// workers before everything else. Where the system refuses, that is one record in `faults` (which
// outlives the threads) and the appliance goes on.
pipeline::ThreadSetup make_thread_setup(hal::Clock& clock, pipeline::FaultLog& faults);

} // namespace octascope::firmware_host
