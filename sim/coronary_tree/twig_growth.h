// Grows the small vessels (orders 4 to 0) from one beginning into their piece of muscle.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/vessels/tree.h"
#include "sim/coronary_tree/heart/region.h"
#include "sim/coronary_tree/low_orders.h"

namespace octascope::sim {

// Shared by all small vessels of one branch.
struct TwigRules {
  pipeline::VesselBranch branch;
  const BranchMorphometry* facts;
  LowOrders low;
  CrownSizes sizes;
};

struct Twig {
  std::size_t order = 0;
  std::uint32_t segments = 0; // including everything that springs from it; at least 1
  std::uint32_t node = 0;     // its first in the tree; the others follow
  std::uint32_t parent = 0;   // the node that it springs from
  Vector3 start;
  Vector3 direction;
  double mother_um = 0;
  Region region; // not empty
};

// Writes exactly `segments` nodes, depth first, starting at `node`, and touches nothing else, so
// that threads can grow different twigs of one tree at once.
void grow_twig(const TwigRules& rules, const Twig& twig, std::uint64_t key,
               pipeline::VesselTree& tree);

} // namespace octascope::sim
