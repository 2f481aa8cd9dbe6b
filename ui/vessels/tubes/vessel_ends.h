// At which nodes a vessel continues, and at which it ends.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/vessels/clusters.h"
#include "ui/vessels/scene/tree_key.h"

namespace octascope::ui {

// Whether the child continues with its parent's whole thickness, as in segment_start_radius().
inline bool goes_on(float parent_radius, float radius) {
  return parent_radius <= pipeline::widest_start * radius;
}

// A bit per node, 32 a word from the lowest: set if another segment of its cluster continues from
// it. A node continued only in another cluster counts as an end: its half ball is hidden inside.
std::vector<std::uint32_t> passed_nodes(const pipeline::VesselClusters& tree);

// Those of the tree that was shown last.
class TreeEnds {
public:
  // Allocates unless the tree is the last one shown.
  void show(const pipeline::VesselClusters& tree);
  const std::vector<std::uint32_t>& passed() const { return passed_; }

private:
  std::vector<std::uint32_t> passed_;
  TreeKey key_;
};

} // namespace octascope::ui
