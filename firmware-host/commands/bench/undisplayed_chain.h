// The chain of a live run without a display: twins, acquisition, reconstruction and volumes, which
// are taken and not drawn.
#pragma once

#include "firmware-host/configuration/configuration.h"
#include "hal/result.h"
#include "pipeline/acquisition/volume_feed.h"

namespace octascope::firmware_host {

// Runs it for that long. The calling thread takes the volumes.
hal::Result<pipeline::VolumeCounters> run_undisplayed(const Configuration& configuration,
                                                      double seconds);

} // namespace octascope::firmware_host
