// The number of small vessels (orders 4 to 0) in a tree of a given size.
//
// The published tables give a tree of 5.9 million segments. A smaller tree omits whole orders from
// below, and a part of the lowest remaining one. A larger tree has `growth` times as many daughters
// on each element of the orders 4 to 1, so that the number of elements grows by growth at order 3,
// its square at order 2, and so on, as the published standard errors do (26 % at order 3, 40 % at
// order 1).
#pragma once

#include <array>

#include "pipeline/vessels/tree.h"
#include "sim/coronary_tree/morphometry.h"
#include "sim/coronary_tree/trunk_plan.h"

namespace octascope::sim {

struct LowOrders {
  double growth = 1;            // daughters per element, relative to the published number
  std::size_t lowest_order = 0; // lower ones are omitted
  double kept = 1;              // fraction of the lowest order's elements that is present

  // Elements of an order, relative to the published number.
  double factor(std::size_t order) const;
};

// Per order: segments of an element and of everything that springs from it, on average.
using CrownSizes = std::array<double, lowest_trunk_order>;
CrownSizes crown_sizes(const BranchMorphometry& branch, const LowOrders& low);

// Average number of segments of an element, without what springs from it.
double segments_per_element(const BranchMorphometry& branch, const LowOrders& low,
                            std::size_t order);

// The small vessels that give that many segments. `beginnings` is the number of elements per branch
// and order that spring from large vessels.
LowOrders
fit_low_orders(const std::array<std::array<std::size_t, lowest_trunk_order>, 3>& beginnings,
               double segments);

// LowOrders::growth of a finished tree for which it is unknown; 1 if there are no more segments
// than published. Segments of unknown branches do not count.
double measured_growth(const pipeline::VesselTree& tree);

} // namespace octascope::sim
