// How well a tree that was found agrees with the true one.
#pragma once

#include <array>

#include "pipeline/vessels/tree.h"

namespace octascope::pipeline {

struct ComparisonRules {
  // The true vessels that must be found: all that are at least so wide. What is found on thinner
  // ones is neither found nor invented, and its errors do not count.
  float least_radius_mm = 0;
  // Farther than this, or than the true vessel's radius where that is more, is not the same vessel.
  float tolerance_mm = 0.05F;
  float step_mm = 0.005F; // between the places that are compared
};

struct AxisErrors {
  double p50_um = 0;
  double p95_um = 0;
  double largest_um = 0;
};

struct TreeComparison {
  double true_length_mm = 0;  // of what must be found
  double found_length_mm = 0; // of the tree that was found
  double found_share = 0;     // of true_length_mm; 1 if there is none
  double invented_share = 0;  // of found_length_mm: where no true vessel is; 0 if there is none
  // From places on what was found, and is no invention, to the nearest true centreline, without sign:
  // by the coordinate, and the distance. 0 if there are none.
  std::array<AxisErrors, 3> axes;
  AxisErrors distance;
  double radius_bias_share = 0; // mean of (found - true) / true, at the same places
};

// Both in one frame. Takes time and memory with the length of both over the step, which must be
// positive.
TreeComparison compare_trees(const VesselTree& found, const VesselTree& truth,
                             const ComparisonRules& rules);

} // namespace octascope::pipeline
