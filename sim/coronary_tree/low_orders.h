// The number of small vessels (orders 4 to 0) in a tree of a given size.
//
// The published tables make a tree of 5.9 million segments. A smaller one is cut from below: whole
// orders are left out, and part of the lowest remaining one. In a larger one each element of orders
// 4 to 1 has `growth` times as many daughters, so that the number of elements grows by growth at
// order 3, its square at order 2, and so on, as the published standard errors do (26 % at order 3,
// 40 % at order 1).
#pragma once

#include <array>
#include <cstdint>

#include "pipeline/vessels/tree.h"
#include "sim/coronary_tree/morphometry.h"
#include "sim/coronary_tree/trunk_plan.h"

namespace octascope::sim {

struct LowOrders {
  double growth = 1;            // daughters of an element, relative to the published number
  std::size_t lowest_order = 0; // lower orders are left out
  double kept = 1;              // share of the lowest order's elements that is present

  // Elements of an order, relative to the published number.
  double factor(std::size_t order) const;
};

// By order: mean number of segments of an element and everything that springs from it.
using CrownSizes = std::array<double, lowest_trunk_order>;
CrownSizes crown_sizes(const BranchMorphometry& branch, const LowOrders& low);

// Mean number of segments of an element alone.
double segments_per_element(const BranchMorphometry& branch, const LowOrders& low,
                            std::size_t order);

// The LowOrders that give this number of segments, where `beginnings` is the number of elements of
// each branch and order that spring from the large vessels.
LowOrders
fit_low_orders(const std::array<std::array<std::size_t, lowest_trunk_order>, 3>& beginnings,
               double segments);

// Estimates LowOrders::growth of a finished tree; 1 if it has no more segments than published.
// Segments of no known branch are ignored.
double measured_growth(const pipeline::VesselTree& tree);

} // namespace octascope::sim
