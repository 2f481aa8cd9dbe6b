// Where blood flows in a phantom, voxel by voxel. The same as a tree: phantom_tree.h.
#pragma once

#include <vector>

#include "pipeline/volume/volume_geometry.h"
#include "sim/phantoms/phantom.h"

namespace octascope::sim {

// Of each voxel, the share of its depth that flows at the beam's place, 0 … 1, in the order
// [b][a][z], depth fastest, as the simulated camera sees it with a plan of that geometry and tissue
// that does not move. A phantom's beam has no width, so a vessel thinner than the spacing between
// A-scans or B-scans is in one or in none of them. Tails below vessels are no flow.
std::vector<float> flow_truth(const Phantom& phantom, const pipeline::VolumeGeometry& geometry);

} // namespace octascope::sim
