// Measures how a tree's vessels lie: whether they run through each other, and how sharply they bend.
#pragma once

#include <array>

#include "pipeline/vessels/tree.h"

namespace octascope::sim {

struct OrderShape {
  std::size_t segments = 0;
  // Of those, how many have another segment nearer to their axis than 0.9 of both radii together
  // that is not near along the tree: more than two segments away, and more than three times both
  // radii together.
  std::size_t crossing = 0;
  // Between a segment of this order and the widest that springs from its end.
  std::size_t bends = 0;
  double mean_turn_degrees = 0;
  std::size_t sharp_turns = 0; // of more than 45 degrees
};

using TreeShape = std::array<OrderShape, pipeline::vessel_order_count>;

TreeShape shape_of(const pipeline::VesselTree& tree);

// Of each node the widest that springs from it (of equals the first); no_parent: none.
std::vector<std::uint32_t> widest_daughters(const pipeline::VesselTree& tree);

} // namespace octascope::sim
