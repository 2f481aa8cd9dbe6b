// Determines at which nodes a vessel continues and at which it ends.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/vessels/clusters.h"
#include "ui/vessels/scene/tree_key.h"

namespace octascope::ui {

// Whether the child continues with its parent's full thickness, as in segment_start_radius().
inline bool goes_on(float parent_radius, float radius) {
  return parent_radius <= pipeline::widest_start * radius;
}

// One bit per node, 32 per word from the lowest: set if another segment of its cluster continues
// from it. If only a segment of another cluster does, the node counts as an end; its half ball is
// then hidden inside.
std::vector<std::uint32_t> passed_nodes(const pipeline::VesselClusters& tree);

// The passed_nodes() of the tree shown last.
class TreeEnds {
public:
  // Allocates only if the tree is not the last one.
  void show(const pipeline::VesselClusters& tree);
  const std::vector<std::uint32_t>& passed() const { return passed_; }

private:
  std::vector<std::uint32_t> passed_;
  TreeKey key_;
};

} // namespace octascope::ui
