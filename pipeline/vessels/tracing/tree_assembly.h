// Fitted lines to a vessel tree.
#pragma once

#include <vector>

#include "pipeline/vessels/tracing/branch_sampling.h"
#include "pipeline/vessels/tree.h"

namespace octascope::pipeline {

// Leaves out connected lines that are shorter than twice their width or three times the grid's widest
// spacing, all together: clusters of noise.
void drop_short(std::vector<VesselLine>& lines, const FlowGrid& grid);

// Two ends of different trees become one vessel where they point at each other, are not more than
// twice as wide as each other, and are apart by no more than twice their width or three of the grid's
// widest spacing. Each tree's root is its widest end. In the volume's frame (registration.h), in mm, with
// orders.
VesselTree assemble_tree(const std::vector<VesselLine>& lines, const FlowGrid& grid);

} // namespace octascope::pipeline
