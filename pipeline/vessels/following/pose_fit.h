// A pose made better: samples of one tree moved onto the vessels of another.
//
// Iterated closest points (Besl, McKay, IEEE Trans. Pattern Anal. Mach. Intell. 14, 1992), from points
// to lines, as where along a vessel a sample lies means nothing; with Tukey's biweight, as some
// vessels are missing and some invented; by Gauss-Newton over a small turn and shift.
#pragma once

#include <span>

#include "pipeline/vessels/following/sample_grid.h"
#include "pipeline/vessels/rigid_transform.h"

namespace octascope::pipeline {

struct FitStage {
  double reach_mm = 0; // what is farther off has no weight
  int iterations = 0;
};

// From `pose`, which takes `samples` to the grid's frame.
RigidTransform fit_pose(const SampleGrid& grid, std::span<const TreeSample> samples,
                        const Point& middle, RigidTransform pose, const FitStage& stage);

// Mean weight of the samples at the pose, 0 to 1.
double pose_score(const SampleGrid& grid, std::span<const TreeSample> samples,
                  const RigidTransform& pose, double reach_mm);

// The sample where `pose` puts it.
TreeSample moved(const TreeSample& sample, const RigidTransform& pose);

} // namespace octascope::pipeline
