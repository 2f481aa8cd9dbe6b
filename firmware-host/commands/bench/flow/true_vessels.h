// A phantom's vessels within the field of a scan.
#pragma once

#include "pipeline/vessels/tree.h"
#include "pipeline/volume/volume_geometry.h"
#include "sim/phantoms/phantom.h"

namespace octascope::firmware_host {

// In the volume's frame, for compare_trees(): each segment by itself, cut off where it leaves the
// volume, which phantom_tree() leaves out.
pipeline::VesselTree vessels_within(const pipeline::VolumeGeometry& geometry,
                                    const sim::Phantom& phantom);

} // namespace octascope::firmware_host
