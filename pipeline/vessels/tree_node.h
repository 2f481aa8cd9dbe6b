// A node more of a tree that is made by hand.
#pragma once

#include <cstdint>

#include "pipeline/vessels/rigid_transform.h"
#include "pipeline/vessels/tree.h"

namespace octascope::pipeline {

// Of no order and no branch. Returns its number, for those that grow from it; `parent` may be no_parent.
inline std::uint32_t add_node(VesselTree& tree, const Point& at, float radius_mm,
                              std::uint32_t parent) {
  tree.positions_mm.push_back(
      {static_cast<float>(at[0]), static_cast<float>(at[1]), static_cast<float>(at[2])});
  tree.radii_mm.push_back(radius_mm);
  tree.parents.push_back(parent);
  tree.orders.push_back(0);
  tree.branches.push_back(VesselBranch::unknown);
  return static_cast<std::uint32_t>(tree.nodes() - 1);
}

} // namespace octascope::pipeline
