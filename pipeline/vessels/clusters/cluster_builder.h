// Packs a tree into clusters.
#pragma once

#include <stop_token>
#include <vector>

#include "pipeline/vessels/clusters.h"
#include "pipeline/vessels/tree.h"

namespace octascope::pipeline {

// Smaller radii are stored as this one: the format's radii are powers.
inline constexpr float thinnest_vessel_mm = 1e-6F;

// The greatest distance of packed nodes from the tree's, measured on every node. Copies that only
// give a direction are not counted.
struct ClusterError {
  float position_um = 0;
  float relative_radius = 0; // of radii from thinnest_vessel_mm up

  bool operator==(const ClusterError&) const = default;
};

struct ClusterArrays {
  std::vector<VesselCluster> clusters;
  std::vector<PackedNode> nodes;
  std::vector<std::uint32_t> sources; // VesselClusters has what they mean
  std::uint64_t segments = 0;
  ClusterError error;

  VesselClusters view() const { return {clusters, nodes, segments, sources}; }
};

// The tree's parents must come before their children; places and radii must be finite, places
// within 10¹² mm, radii not negative, orders at most highest_vessel_order. Nodes without a segment
// (roots) become references; a root without a child is in no cluster. Deterministic.
// cluster_partition.h has what shares a cluster. Once `stop` is requested it leaves soon, with
// nothing.
ClusterArrays build_clusters(const VesselTree& tree, const std::stop_token& stop = {});

} // namespace octascope::pipeline
