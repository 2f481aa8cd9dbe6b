// Cuts a tree into connected pieces, each small enough for a cluster (cluster_partition.h).
#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <vector>

#include "pipeline/vessels/clusters/tree_piece.h"

namespace octascope::pipeline {

// What a piece may have: a cluster without the two references that it needs.
inline constexpr std::uint32_t largest_piece = largest_cluster - 2;

struct TreePieces {
  std::vector<TreePiece> pieces;
  std::vector<std::uint32_t> piece_of; // by node, a root's is no_parent
};

// `depth_first`: all nodes, each after its parent and each subtree in one piece. Once `stop` is
// requested it leaves soon, with nothing.
TreePieces cut_tree(const VesselTree& tree, std::span<const std::uint32_t> depth_first,
                    const std::stop_token& stop = {});

} // namespace octascope::pipeline
