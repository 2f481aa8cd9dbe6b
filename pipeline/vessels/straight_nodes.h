// Fewer nodes for the same lines. Pure.
#pragma once

#include "pipeline/vessels/tree.h"

namespace octascope::pipeline {

// The tree without nodes that lie on straight vessels: what is left out is within `tolerance_mm` of the
// segment that takes its place, and as wide as that is there, within as much. Roots, tips and branch points
// stay. From each node on as far as it goes (the opening-window rule).
VesselTree without_straight_nodes(const VesselTree& tree, double tolerance_mm);

} // namespace octascope::pipeline
