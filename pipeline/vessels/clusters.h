// A vessel tree as it is kept for drawing, on disk and in memory: clusters of up to 255
// neighbouring nodes, eight bytes a node.
//
// A node's place is a multiple of its cluster's step (14 bits an axis), its radius a power between
// the cluster's smallest and largest (10 bits), its parent an index in the same cluster (8 bits).
// Where the parent belongs to another cluster, this one has a copy of it, and of the parent's
// parent for the direction in which the vessel comes: references, which make no segment. What is
// there for the direction alone may stand nearer than it is, on the line from the parent: else the
// cluster's box would reach out to it.
//
// In a cluster references come first, then segments from the highest order to the lowest; those of
// one order in an order drawn by lot, so that the first n of them are a fair sample of all.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>

#include "pipeline/vessels/tree.h"

namespace octascope::pipeline {

inline constexpr int largest_cluster = 255; // nodes
inline constexpr std::uint32_t vessel_place_steps = (1U << 14) - 1;
inline constexpr std::uint32_t vessel_radius_steps = (1U << 10) - 1;
inline constexpr unsigned reference_order = 15; // marks a node that makes no segment

// Two words, as a GL texture of two 32-bit channels has them:
//   low:  x (14) | y (14) | the 4 lowest bits of z
//   high: the 10 highest bits of z | radius (10) | parent (8) | order (4), from bit 0 up.
struct PackedNode {
  std::uint32_t low;
  std::uint32_t high;

  std::uint32_t x() const { return low & 0x3FFF; }
  std::uint32_t y() const { return low >> 14 & 0x3FFF; }
  std::uint32_t z() const { return low >> 28 | (high & 0x3FF) << 4; }
  std::uint32_t radius() const { return high >> 10 & 0x3FF; }
  std::uint32_t parent() const { return high >> 20 & 0xFF; } // its own index: has none
  unsigned order() const { return high >> 28; }
  bool is_reference() const { return order() == reference_order; }
};
static_assert(sizeof(PackedNode) == 8);

struct VesselCluster {
  std::array<float, 3> origin_mm;
  std::array<float, 3> step_mm; // place = origin + step · packed
  float smallest_radius_mm;
  float log2_radius_step;   // radius = smallest · 2^(step · packed)
  float largest_radius_mm;  // of what is drawn: of no reference that is thicker
  float length_mm;          // of all segments together
  float side_area_mm2;      // Σ diameter · length: what they could cover
  std::uint32_t first_node; // in VesselClusters::nodes
  std::uint8_t nodes;       // references included
  std::uint8_t references;
  VesselBranch branch;
  std::uint8_t unused;
  // How many nodes have that order or a higher one, references included: where the segments of
  // each order end.
  std::array<std::uint8_t, vessel_order_count> nodes_from_order;

  std::uint32_t segments() const { return static_cast<std::uint32_t>(nodes - references); }
};
static_assert(sizeof(VesselCluster) == 64 && std::is_trivially_copyable_v<VesselCluster>);

// Borrowed: from a ClusterFile or from ClusterArrays.
struct VesselClusters {
  std::span<const VesselCluster> clusters;
  std::span<const PackedNode> nodes;
  std::uint64_t segments = 0;
  // Of every reference, cluster by cluster: the index in `nodes` of the node that it is a copy of;
  // of a root, which has no segment anywhere, that of its first copy. Drawing does not need it.
  std::span<const std::uint32_t> sources = {};
};

struct VesselNode {
  std::array<float, 3> position_mm;
  float radius_mm;
};

inline VesselNode unpack(const VesselCluster& cluster, PackedNode node) {
  const auto place = [&](std::size_t axis, std::uint32_t steps) {
    return cluster.origin_mm[axis] + cluster.step_mm[axis] * static_cast<float>(steps);
  };
  return {{place(0, node.x()), place(1, node.y()), place(2, node.z())},
          cluster.smallest_radius_mm *
              std::exp2(cluster.log2_radius_step * static_cast<float>(node.radius()))};
}

} // namespace octascope::pipeline
