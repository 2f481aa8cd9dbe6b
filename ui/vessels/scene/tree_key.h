// Identifies trees that were prepared for drawing.
#pragma once

#include <algorithm>
#include <cstdint>

#include "pipeline/vessels/clusters.h"

namespace octascope::ui {

// The nodes' address, their number, and a sample of them, since addresses are reused.
struct TreeKey {
  const pipeline::PackedNode* nodes = nullptr;
  std::size_t count = 0;
  std::uint64_t sample = 0;

  bool operator==(const TreeKey&) const = default;
};

inline TreeKey tree_key(const pipeline::VesselClusters& tree) {
  constexpr std::size_t sampled_nodes = 64;
  TreeKey key{tree.nodes.data(), tree.nodes.size(), tree.segments};
  const std::size_t stride = std::max<std::size_t>(1, tree.nodes.size() / sampled_nodes);
  for (std::size_t i = 0; i < tree.nodes.size(); i += stride)
    key.sample = (key.sample ^ tree.nodes[i].low ^ std::uint64_t{tree.nodes[i].high} << 32U) *
                 0x9E3779B97F4A7C15U;
  return key;
}

} // namespace octascope::ui
