// Paths of voxels to lines of points, about as far apart as the vessel is thick.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/vessels/tracing/voxel_paths.h"

namespace octascope::pipeline {

// In the volume's frame, in µm.
struct VesselLine {
  static constexpr std::uint32_t no_line = 0xFFFFFFFF;

  std::vector<Point> points; // two at least
  std::vector<double> radii; // of the points
  std::uint32_t from =
      no_line;          // an earlier line, that this one leaves; its points begin outside it
  std::size_t fork = 0; // the point of that line
};

// Paths that leave nothing beyond the wall of the one that they leave become no line; what leaves them
// leaves that one.
std::vector<VesselLine> sample_paths(const std::vector<VoxelPath>& paths,
                                     const FlowingVoxels& voxels, const FlowGrid& grid,
                                     const std::vector<float>& wall_um);

// Paths reach into a corner of a vessel's end, where lines stop as far from the wall as it is wide.
// Lengthens them, straight on, for as long as the vessel is not narrower than 0.6 of their radius: to
// the border of the volume, through which it goes on.
void extend_ends(std::vector<VesselLine>& lines, const FlowingVoxels& voxels, const FlowGrid& grid,
                 const std::vector<float>& wall_um);

// The index of the line's point that is nearest.
std::size_t nearest_point(const VesselLine& line, const Point& to);

} // namespace octascope::pipeline
