// Which segments of a tree share a cluster.
//
// From the leaves upwards the tree is cut into connected pieces that fit into a cluster, and small
// pieces that lie side by side then share one. What may not share: segments of two main branches;
// thick and thin ones, where a bound between them cuts few joints (a cluster of capillaries alone
// can be judged as a whole, one with a trunk among them cannot); and what makes the box so large
// that its steps would show on the thinnest vessel in it.
//
// The cutting is the greedy one of trees into parts of bounded size (Kundu and Misra, "A linear
// tree partitioning algorithm", SIAM J Comput 6, 1977): where the pieces of a node's children are
// too much for one, the largest are cut off.
#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "pipeline/vessels/tree.h"

namespace octascope::pipeline {

struct ClusterPartition {
  // Segments by cluster, within a cluster and from one to the next depth first: neighbours in the
  // tree, and mostly in space, are neighbours here.
  std::vector<std::uint32_t> segments;
  std::vector<std::uint32_t> ends; // of each cluster, in `segments`
};

// Of each cluster, no more than largest_cluster nodes with the references that it needs.
// Deterministic; linear in the tree's size but for a sort of what is small. Once `stop` is
// requested it leaves soon, with nothing.
ClusterPartition partition_tree(const VesselTree& tree, const std::stop_token& stop = {});

} // namespace octascope::pipeline
