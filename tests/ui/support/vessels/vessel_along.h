// A vessel where a test wants it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "pipeline/vessels/clusters/cluster_builder.h"

namespace octascope::tests {

// One vessel after the other, through these places of the volume's frame.
inline pipeline::ClusterArrays vessel_along(const std::vector<std::array<float, 3>>& places_mm,
                                            float radius_mm) {
  pipeline::VesselTree tree;
  for (std::size_t i = 0; i < places_mm.size(); ++i) {
    tree.positions_mm.push_back(places_mm[i]);
    tree.radii_mm.push_back(radius_mm);
    tree.parents.push_back(i == 0 ? pipeline::no_parent : static_cast<std::uint32_t>(i - 1));
    tree.orders.push_back(8);
    tree.branches.push_back(pipeline::VesselBranch::unknown);
  }
  return pipeline::build_clusters(tree);
}

} // namespace octascope::tests
