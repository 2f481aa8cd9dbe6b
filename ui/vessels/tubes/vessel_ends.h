// Which nodes are passed by a vessel, and at which it ends.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/vessels/clusters.h"
#include "ui/vessels/scene/tree_key.h"

namespace octascope::ui {

// Does the child go on with its parent's whole thickness? As segment_start_radius().
inline bool goes_on(float parent_radius, float radius) {
  return parent_radius <= pipeline::widest_start * radius;
}

// A bit a node, 32 a word from the lowest: set where another segment of its cluster goes on from
// it. Where one of another cluster does, the node counts as an end, too: its half ball is hidden
// within.
std::vector<std::uint32_t> passed_nodes(const pipeline::VesselClusters& tree);

// Those of the tree that was shown last.
class TreeEnds {
public:
  // Allocates for a tree that it has not shown last.
  void show(const pipeline::VesselClusters& tree);
  const std::vector<std::uint32_t>& passed() const { return passed_; }

private:
  std::vector<std::uint32_t> passed_;
  TreeKey key_;
};

} // namespace octascope::ui
