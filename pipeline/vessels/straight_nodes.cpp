#include "pipeline/vessels/straight_nodes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/vessels/vectors.h"

namespace octascope::pipeline {

namespace {

Point point_of(const VesselTree& tree, std::uint32_t node) {
  const auto& at = tree.positions_mm[node];
  return {double{at[0]}, double{at[1]}, double{at[2]}};
}

// Whether one segment may take the place of those of the chain.
bool is_straight(const VesselTree& tree, std::span<const std::uint32_t> chain,
                 double tolerance_mm) {
  const Point from = point_of(tree, chain.front());
  const Point along = difference(point_of(tree, chain.back()), from);
  const double square = product(along, along);
  const double radius = double{tree.radii_mm[chain.front()]};
  const double growth = double{tree.radii_mm[chain.back()]} - radius;
  return std::ranges::all_of(chain, [&](std::uint32_t node) {
    const Point apart = difference(point_of(tree, node), from);
    const double share = square > 0 ? std::clamp(product(apart, along) / square, 0.0, 1.0) : 0;
    return length(difference(apart, scaled(along, share))) <= tolerance_mm &&
           std::fabs(double{tree.radii_mm[node]} - radius - share * growth) <= tolerance_mm;
  });
}

// Marks what stays of a chain, the ends of which do.
void mark(const VesselTree& tree, std::span<const std::uint32_t> chain, double tolerance_mm,
          std::vector<std::uint8_t>& stays) {
  std::size_t from = 0;
  for (std::size_t to = 2; to < chain.size(); ++to)
    if (!is_straight(tree, chain.subspan(from, to + 1 - from), tolerance_mm)) {
      from = to - 1;
      stays[chain[from]] = 1;
    }
}

std::vector<std::uint8_t> what_stays(const VesselTree& tree, double tolerance_mm) {
  std::vector<std::uint32_t> children(tree.nodes());
  for (const std::uint32_t parent : tree.parents)
    if (parent != no_parent)
      ++children[parent];
  std::vector<std::uint8_t> ends(tree.nodes());
  for (std::size_t i = 0; i < tree.nodes(); ++i)
    ends[i] = tree.parents[i] == no_parent || children[i] != 1 ? 1 : 0;
  std::vector<std::uint8_t> stays = ends;
  std::vector<std::uint32_t> chain;
  for (std::uint32_t i = 0; i < tree.nodes(); ++i) {
    if (ends[i] == 0 || tree.parents[i] == no_parent)
      continue;
    chain.assign(1, i);
    do
      chain.push_back(tree.parents[chain.back()]);
    while (ends[chain.back()] == 0);
    mark(tree, chain, tolerance_mm, stays);
  }
  return stays;
}

} // namespace

VesselTree without_straight_nodes(const VesselTree& tree, double tolerance_mm) {
  const std::vector<std::uint8_t> stays = what_stays(tree, tolerance_mm);
  VesselTree left;
  std::vector<std::uint32_t> node_of(tree.nodes()); // or of the next that stays towards the root
  for (std::size_t i = 0; i < tree.nodes(); ++i) {
    const std::uint32_t parent = tree.parents[i];
    if (stays[i] == 0) {
      node_of[i] = node_of[parent];
      continue;
    }
    node_of[i] = static_cast<std::uint32_t>(left.nodes());
    left.positions_mm.push_back(tree.positions_mm[i]);
    left.radii_mm.push_back(tree.radii_mm[i]);
    left.parents.push_back(parent == no_parent ? no_parent : node_of[parent]);
    left.orders.push_back(tree.orders[i]);
    left.branches.push_back(tree.branches[i]);
  }
  return left;
}

} // namespace octascope::pipeline
