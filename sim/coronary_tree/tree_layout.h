// Assigns the nodes of the finished tree: the number of segments of each large vessel and each
// beginning of small ones, adding up to exactly the number asked for.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "sim/coronary_tree/low_orders.h"
#include "sim/coronary_tree/trunk_plan.h"

namespace octascope::sim {

// Beside each planned element.
struct LaidOutElement {
  std::uint32_t own = 0;  // its own segments that are present
  std::uint32_t all = 0;  // including everything that springs from it
  std::uint32_t node = 0; // its first
  std::uint32_t parent = 0;
};

struct TreeLayout {
  LowOrders low;
  std::size_t lowest_trunk_order = 0; // lower orders are left out
  std::array<std::vector<LaidOutElement>, 3> branches;
  std::array<std::uint32_t, 3> roots{}; // nodes
  std::uint32_t nodes = 0;
};

// Depth first: an element's segment, what springs off at its end, the next segment. One root per
// branch. `segments` must be at least 1000.
TreeLayout lay_out(const std::array<TrunkPlan, 3>& plans, std::uint32_t segments,
                   std::uint64_t key);

} // namespace octascope::sim
