// Places along a vessel tree, with the direction that the vessel has there.
#pragma once

#include <vector>

#include "pipeline/vessels/rigid_transform.h"
#include "pipeline/vessels/tree.h"

namespace octascope::pipeline {

struct TreeSample {
  Point at{};           // mm
  Point along{};        // of length 1; its sign has no meaning
  double radius_mm = 0; // of the vessel
  double length_mm = 0; // of the vessel, that this sample stands for
};

// Edges parallel to the axes, in mm.
struct PointBox {
  Point lower{}, upper{};

  bool contains(const Point& p) const;
  // By as much on every side.
  PointBox grown(double by_mm) const;
  Point middle() const;
  double longest_side() const;
};

// Around all nodes. `tree` has at least one.
PointBox box_around(const VesselTree& tree);

// One about every `step_mm` along each vessel from fork to fork, in the middle of its piece, where
// `place` puts the tree; only those within `box`. Directions are those of a chord of three steps, as
// nodes may be close together and each a little off. What is shorter than a step is left out.
// Takes time with the tree's nodes.
std::vector<TreeSample> sample_tree(const VesselTree& tree, double step_mm,
                                    const RigidTransform& place, const PointBox& box);

} // namespace octascope::pipeline
