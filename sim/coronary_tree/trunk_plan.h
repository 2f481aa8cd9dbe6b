// Which large vessels there are and how they connect: the elements of orders 5 and higher of one
// artery, and the elements of lower orders that spring from them, where the small vessels begin.
//
// The published numbers of elements and connections are met, not only on average: each order has
// exactly its published number of elements, each pair of orders its published number of joints up
// to rounding, each order its mean of segments per element. Only the assignment is random. Where
// the tables of connectivity and of totals contradict each other, the totals are kept.
#pragma once

#include <cstdint>
#include <vector>

#include "sim/coronary_tree/morphometry.h"

namespace octascope::sim {

inline constexpr std::size_t lowest_trunk_order = 5;
inline constexpr std::size_t lowest_outer_order = 9; // runs upon the heart

struct PlannedElement {
  std::size_t order = 0;
  std::uint32_t segments = 0; // 0: of a lower order, where small vessels begin
  std::uint32_t mother = 0;   // for the root: itself
  std::uint32_t joint = 0;    // springs from the end of this segment of the mother
  std::uint32_t first_daughter = 0;
  std::uint32_t daughters = 0;
  bool on_course = false; // the artery itself, or its continuation
  double weight = 0;      // amount of muscle it feeds, in any unit

  bool is_trunk() const { return order >= lowest_trunk_order; }
};

// Mothers come before daughters, the root first; daughters of one mother are contiguous.
struct TrunkPlan {
  std::vector<PlannedElement> elements;
};

// `weights`: the amount of muscle fed by an element of each order below 5.
TrunkPlan plan_trunk(const BranchMorphometry& branch,
                     const std::array<double, lowest_trunk_order>& weights, std::uint64_t key);

} // namespace octascope::sim
