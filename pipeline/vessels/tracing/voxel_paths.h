// Paths of voxels through what flows: one from the root of each component to each of its tips.
//
// Sato, Bitter, Bender, Kaufman, Nakajima, TEASAR: tree-structure extraction algorithm for accurate
// and robust skeletons (Pacific Graphics 2000): the least-cost path to the farthest voxel is a
// branch, the voxels around it are done with, and so on until none is left. A step costs its length
// by the square of the distance from the wall, so that paths keep to the middle of wide and narrow
// vessels alike.
#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "pipeline/vessels/tracing/flowing_voxels.h"

namespace octascope::pipeline {

struct VoxelPath {
  static constexpr std::uint32_t no_path = 0xFFFFFFFF;

  std::vector<std::uint32_t> voxels; // to the tip; the first one belongs to `from`, if there is one
  std::uint32_t from = no_path;      // an earlier path
};

// `wall_um`: wall_distances(). Paths that leave another by less than its width, or their own, are
// bulges of the wall and left out.
std::vector<VoxelPath> find_voxel_paths(const FlowingVoxels& voxels, const FlowGrid& grid,
                                        const std::vector<float>& wall_um,
                                        const std::stop_token& stop);

} // namespace octascope::pipeline
