// The segments of a tree as lines in space: how near two come, and how near they are along the tree.
#pragma once

#include "pipeline/vessels/tree.h"
#include "sim/coronary_tree/heart/vector3.h"

namespace octascope::sim {

inline Vector3 node_place(const pipeline::VesselTree& tree, std::uint32_t node) {
  const auto& p = tree.positions_mm[node];
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

struct Line {
  Vector3 from;
  Vector3 to;
};

// Of any node but a root.
inline Line segment_line(const pipeline::VesselTree& tree, std::uint32_t node) {
  return {node_place(tree, tree.parents[node]), node_place(tree, node)};
}

// Where two lines are nearest: from 0, at `from`, to 1, at `to`.
struct Approach {
  double a;
  double b;
  Vector3 apart; // from the place on b to the one on a
};

// After Ericson, Real-Time Collision Detection (2005), 5.1.9.
Approach nearest_approach(const Line& a, const Line& b);

// Whether the way along the tree between two segments (without themselves) is no longer than
// `near_mm`, or leads through two segments at most. Segments of different trees are never near.
bool near_along_tree(const pipeline::VesselTree& tree, std::uint32_t a, std::uint32_t b,
                     double near_mm);

} // namespace octascope::sim
