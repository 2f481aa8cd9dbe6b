// Where a tree might lie: every turn and shift within reach, coarsely.
//
// Turns about the middle, 7 degrees apart; for each of them all shifts in steps of 75 µm. A pose counts
// by how many of some 130 samples of the live tree then lie near a planned vessel of about their
// direction, from one byte a cell and direction. Directions make the difference: in a dense bed
// half of all places are near some vessel, a tenth are near one that runs the same way.
// Exhaustive, so that nothing depends on forks, which tracing finds least reliably.
#pragma once

#include <span>
#include <vector>

#include "pipeline/vessels/following/tree_samples.h"
#include "pipeline/vessels/rigid_transform.h"

namespace octascope::pipeline {

struct PoseReach {
  double turn_deg = 0;
  double shift_mm = 0;
};

// The best candidates first, up to about 100 of them, as transforms from the live tree to the planned one;
// `planned` and `live` in one frame, off by no more than `reach` about `middle`. Takes 13 bytes a
// cell of 75 µm of all that is within reach.
std::vector<RigidTransform> search_poses(std::span<const TreeSample> planned,
                                         std::span<const TreeSample> live, const Point& middle,
                                         const PoseReach& reach);

// A turn about `middle` by the length of `turn_rad` about its direction (Rodrigues), then a shift.
RigidTransform turned_about(const Point& middle, const Point& turn_rad, const Point& shift_mm);

} // namespace octascope::pipeline
