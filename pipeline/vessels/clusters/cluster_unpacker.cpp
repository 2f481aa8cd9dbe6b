#include "pipeline/vessels/clusters/cluster_unpacker.h"

#include <algorithm>
#include <vector>

namespace octascope::pipeline {
namespace {

class Unpacker {
public:
  explicit Unpacker(const VesselClusters& packed) : packed_{packed} {
    const std::size_t count = packed.nodes.size();
    originals_.resize(count);
    cluster_of_.resize(count);
    number_.assign(count, not_yet);
    std::size_t reference = 0;
    for (std::uint32_t c = 0; c < packed.clusters.size(); ++c) {
      const VesselCluster& cluster = packed.clusters[c];
      for (std::uint32_t i = 0; i < cluster.nodes; ++i) {
        const std::uint32_t node = cluster.first_node + i;
        cluster_of_[node] = c;
        originals_[node] = i < cluster.references ? packed.sources[reference++] : node;
      }
    }
  }

  hal::Result<VesselTree> unpack(const std::function<void(double)>& progress) {
    constexpr std::uint32_t between = 1U << 16; // nodes
    reserve();
    for (std::uint32_t node = 0; node < packed_.nodes.size(); ++node) {
      if (progress && node % between == 0)
        progress(static_cast<double>(node) / static_cast<double>(packed_.nodes.size()));
      if (originals_[node] == node && number_[node] == not_yet)
        if (!add_with_ancestors(node))
          return hal::fail(hal::ErrorCode::bad_data,
                           "vessel clusters: the segment of packed node {} is its own ancestor, "
                           "expected a tree; make the file anew",
                           node);
    }
    return std::move(tree_);
  }

private:
  static constexpr std::uint32_t not_yet = no_parent;
  static constexpr std::uint32_t on_the_way = no_parent - 1;

  void reserve() {
    const auto count = static_cast<std::size_t>(packed_.segments) + 1;
    tree_.positions_mm.reserve(count);
    tree_.radii_mm.reserve(count);
    tree_.parents.reserve(count);
    tree_.orders.reserve(count);
    tree_.branches.reserve(count);
  }

  bool is_root(std::uint32_t node) const { return packed_.nodes[node].is_reference(); }

  std::uint32_t parent_of(std::uint32_t node) const {
    return originals_[packed_.clusters[cluster_of_[node]].first_node +
                      packed_.nodes[node].parent()];
  }

  // False where the way up comes back to itself.
  bool add_with_ancestors(std::uint32_t node) {
    way_.clear();
    bool root = false;
    while (number_[node] == not_yet && !root) {
      number_[node] = on_the_way;
      way_.push_back(node);
      root = is_root(node);
      if (!root)
        node = parent_of(node);
    }
    if (number_[node] == on_the_way && !root)
      return false;
    for (; !way_.empty(); way_.pop_back())
      add(way_.back());
    return true;
  }

  void add(std::uint32_t node) {
    const VesselCluster& cluster = packed_.clusters[cluster_of_[node]];
    const VesselNode unpacked = pipeline::unpack(cluster, packed_.nodes[node]);
    const bool root = is_root(node);
    const std::uint32_t parent = root ? no_parent : number_[parent_of(node)];
    const auto order = static_cast<std::uint8_t>(root ? 0 : packed_.nodes[node].order());
    number_[node] = static_cast<std::uint32_t>(tree_.nodes());
    tree_.positions_mm.push_back(unpacked.position_mm);
    tree_.radii_mm.push_back(unpacked.radius_mm);
    tree_.parents.push_back(parent);
    tree_.orders.push_back(order);
    tree_.branches.push_back(cluster.branch);
    if (!root && tree_.parents[parent] == no_parent)
      tree_.orders[parent] = std::max(tree_.orders[parent], order);
  }

  const VesselClusters& packed_;
  std::vector<std::uint32_t> originals_;  // by packed node
  std::vector<std::uint32_t> cluster_of_; // by packed node
  std::vector<std::uint32_t> number_;     // by packed node that is no copy: in the tree
  std::vector<std::uint32_t> way_;        // from a node towards its root
  VesselTree tree_;
};

} // namespace

hal::Result<VesselTree> unpack_tree(const VesselClusters& clusters,
                                    const std::function<void(double)>& progress) {
  return Unpacker{clusters}.unpack(progress);
}

} // namespace octascope::pipeline
