// Facts about a tree that was packed into clusters.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "pipeline/vessels/clusters/cluster_builder.h"

namespace octascope::pipeline {

struct VesselFacts {
  std::uint64_t nodes = 0; // of the tree, without references
  std::uint64_t roots = 0;
  std::uint64_t lone_roots = 0;    // among them, those without a child: they are in no cluster
  std::uint64_t branch_points = 0; // nodes with two children or more
  std::uint64_t zero_lengths = 0;  // segments whose ends are in the same place
  std::array<std::array<std::uint64_t, vessel_order_count>, vessel_branch_count> segments{};
  // Around the nodes' places; all zero for a tree without nodes.
  std::array<float, 3> lower_mm{};
  std::array<float, 3> upper_mm{};
  ClusterError error;
  std::string provenance; // where the tree came from, for people: one line or several

  std::uint64_t all_segments() const { return nodes - roots; }
  std::uint64_t segments_of(VesselBranch branch) const;
  std::uint64_t segments_of(int order) const;

  bool operator==(const VesselFacts&) const = default;
};

// `error`: ClusterArrays::error of the same tree.
VesselFacts facts_of(const VesselTree& tree, const ClusterError& error, std::string provenance);

} // namespace octascope::pipeline
