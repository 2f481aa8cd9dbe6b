// What a vessel tree is made of, in numbers.
#pragma once

#include <array>
#include <cstdint>

#include "pipeline/vessels/tree.h"

namespace octascope::pipeline {

struct OrderSummary {
  std::uint64_t segments = 0;
  double length_mm = 0;
  double mean_diameter_mm = 0; // over segments, at their ends
};

struct TreeSummary {
  std::uint64_t nodes = 0;
  std::uint64_t segments = 0; // nodes that are no roots
  std::uint64_t roots = 0;
  std::uint64_t branch_points = 0; // nodes with two children or more
  std::uint64_t tips = 0;          // nodes without any
  double length_mm = 0;
  std::array<float, 3> lowest_mm{}; // corners of the box around all nodes, radii left out
  std::array<float, 3> highest_mm{};
  float smallest_radius_mm = 0;
  float largest_radius_mm = 0;
  std::array<OrderSummary, vessel_order_count> orders;
  std::array<std::uint64_t, vessel_branch_count> branches{}; // segments, by VesselBranch
};

// Orders must be at most highest_vessel_order. All zero for a tree without nodes.
TreeSummary summarise(const VesselTree& tree);

} // namespace octascope::pipeline
