// Puts segments into one cluster after another.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/vessels/clusters/cluster_builder.h"
#include "pipeline/vessels/clusters/tree_piece.h"

namespace octascope::pipeline {

class ClusterPacker {
public:
  explicit ClusterPacker(const VesselTree& tree);

  // A cluster of these segments, all of one branch, and the references that they need: no more than
  // largest_cluster nodes.
  void pack(std::span<const std::uint32_t> segments);

  // When every segment has been packed.
  ClusterArrays finish();

private:
  static constexpr std::uint32_t nowhere = no_parent;

  bool here(std::uint32_t node) const { return places_[node] != nowhere; }
  void find_references();
  void sort_members();
  void number();
  VesselCluster frame();
  void pack_nodes(VesselCluster& cluster);
  void shorten_directions(TreeBox& box);
  void clear();
  PackedNode pack_node(const VesselCluster& cluster, std::uint32_t node,
                       const std::array<float, 3>& at, unsigned order) const;
  void note_error(const VesselCluster& cluster, std::uint32_t node, PackedNode packed);

  // A node that is copied into the cluster.
  struct Reference {
    std::uint32_t node;
    bool is_parent; // of a segment here; else it gives a direction to the one after it
    std::array<float, 3> at;
  };

  const VesselTree& tree_;
  ClusterArrays arrays_;
  std::vector<std::uint32_t> packed_at_; // by node: the index of its segment, or first copy
  std::vector<std::uint32_t> places_;    // by node: in the cluster that is being packed
  std::vector<std::uint32_t> members_;
  std::vector<Reference> references_;
};

} // namespace octascope::pipeline
