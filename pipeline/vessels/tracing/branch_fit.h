// Moves lines to the middle of the flow, and measures how wide it is there.
//
// Each flowing voxel belongs to the point with the least power (squared distance less squared radius),
// so that a twig takes nothing of its trunk. A point moves across its line to the mean place of its
// flow and its neighbours'; its radius is that of a disc of the area that flows. A voxel that flows in
// part counts in part, which gives places between voxels. Then the line is smoothed (Whittaker, Proc
// Edinburgh Math Soc 41, 1923: squares of second differences), which leaves straight lines and ends where
// they are. Twice, as each step changes what belongs to whom.
#pragma once

#include <stop_token>
#include <vector>

#include "pipeline/vessels/tracing/branch_sampling.h"

namespace octascope::pipeline {

struct FlowOfLines {
  double explained = 0; // flow that belongs to a line
  // 1 where the flow around each line is a disc, less the more it is spread: the area over that of a
  // disc of the same second moment, weighted by flow.
  double roundness = 0;
};

void fit_lines(std::vector<VesselLine>& lines, const FlowingVoxels& voxels, const FlowGrid& grid,
               const std::stop_token& stop);

FlowOfLines flow_of_lines(std::vector<VesselLine>& lines, const FlowingVoxels& voxels,
                          const FlowGrid& grid, const std::stop_token& stop);

} // namespace octascope::pipeline
