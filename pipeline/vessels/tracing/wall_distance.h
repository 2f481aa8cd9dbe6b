// How far each flowing voxel is from what does not flow.
#pragma once

#include <stop_token>
#include <vector>

#include "pipeline/vessels/tracing/flowing_voxels.h"

namespace octascope::pipeline {

// In µm, by voxel, exact between middles of voxels and then half the narrowest side less, which is
// about where the wall is. What lies outside the grid is no wall: a vessel that leaves the volume stays
// as wide as it is. Separable, as in Saito and Toriwaki, Pattern Recognition 27, 1994; each search
// ends at the distance that is known so far.
std::vector<float> wall_distances(const FlowingVoxels& voxels, const FlowGrid& grid,
                                  const std::stop_token& stop);

} // namespace octascope::pipeline
