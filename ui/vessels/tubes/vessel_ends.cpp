#include "ui/vessels/tubes/vessel_ends.h"

namespace octascope::ui {

std::vector<std::uint32_t> passed_nodes(const pipeline::VesselClusters& tree) {
  std::vector<std::uint32_t> bits((tree.nodes.size() + 31) / 32);
  for (const pipeline::VesselCluster& cluster : tree.clusters)
    for (std::uint32_t i = cluster.references; i < cluster.nodes; ++i) {
      const pipeline::PackedNode node = tree.nodes[cluster.first_node + i];
      const std::uint32_t parent = cluster.first_node + node.parent();
      if (goes_on(unpack(cluster, tree.nodes[parent]).radius_mm, unpack(cluster, node).radius_mm))
        bits[parent / 32] |= 1U << parent % 32;
    }
  return bits;
}

void TreeEnds::show(const pipeline::VesselClusters& tree) {
  const TreeKey key = tree_key(tree);
  if (key == key_)
    return;
  passed_ = passed_nodes(tree);
  key_ = key;
}

} // namespace octascope::ui
