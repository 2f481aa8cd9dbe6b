// How many small vessels (orders 4 to 0) a tree of a given size has.
//
// The published tables make a tree of 5.9 million segments. A smaller one is cut from below: whole
// orders are left out, and of the lowest one that remains a part. A larger one has more daughters
// on each element of the orders 4 to 1: `growth` times as many, so that the number of elements
// grows by growth at order 3, its square at order 2, and so on, as the published standard errors do
// (26 % at order 3, 40 % at order 1).
#pragma once

#include <array>

#include "pipeline/vessels/tree.h"
#include "sim/coronary_tree/morphometry.h"
#include "sim/coronary_tree/trunk_plan.h"

namespace octascope::sim {

struct LowOrders {
  double growth = 1;            // daughters of an element, relative to the published number
  std::size_t lowest_order = 0; // those below are left out
  double kept = 1;              // part of the lowest order's elements that is there

  // Elements of an order, relative to the published number.
  double factor(std::size_t order) const;
};

// By order: segments of an element and of all that springs from it, on average.
using CrownSizes = std::array<double, lowest_trunk_order>;
CrownSizes crown_sizes(const BranchMorphometry& branch, const LowOrders& low);

// Segments of an element on average, without what springs from it.
double segments_per_element(const BranchMorphometry& branch, const LowOrders& low,
                            std::size_t order);

// The small vessels that make so many segments, where `beginnings` says how many elements of each
// branch and order spring from the large ones.
LowOrders
fit_low_orders(const std::array<std::array<std::size_t, lowest_trunk_order>, 3>& beginnings,
               double segments);

// LowOrders::growth of a finished tree that does not say; 1 where there are no more segments than
// published. Segments of no known branch do not count.
double measured_growth(const pipeline::VesselTree& tree);

} // namespace octascope::sim
