#include "firmware-host/commands/bench/registration/imperfect_tree.h"

#include <cstddef>
#include <cstdint>
#include <vector>

#include "pipeline/vessels/tree_node.h"
#include "pipeline/vessels/vectors.h"

namespace octascope::firmware_host {

namespace {

using pipeline::add_node;
using pipeline::no_parent;
using pipeline::Point;
using pipeline::VesselTree;

Point place_of(const VesselTree& tree, std::size_t node) {
  const auto& at = tree.positions_mm[node];
  return {double{at[0]}, double{at[1]}, double{at[2]}};
}

// How far each node is off: an autoregression along the vessel, of the standard deviation wanted.
Point next_error(const Point& before, double off_mm, sim::HashRandom& random) {
  constexpr double kept = 0.9;
  constexpr double fresh = 0.436; // √(1 − 0.9²)
  Point error{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    error[axis] = kept * before[axis] + fresh * off_mm * random.normal();
  return error;
}

double add_invented(VesselTree& tree, const pipeline::PointBox& field, sim::HashRandom& random) {
  Point at{}, along{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    at[axis] = field.lower[axis] + random.unit() * (field.upper[axis] - field.lower[axis]);
    along[axis] = random.both_ways();
  }
  constexpr int pieces = 6;
  constexpr double piece_mm = 0.05;
  constexpr float radius_mm = 0.02F;
  std::uint32_t parent = no_parent;
  for (int i = 0; i <= pieces; ++i) {
    parent = add_node(tree, at, radius_mm, parent);
    at = pipeline::sum(at, pipeline::scaled(pipeline::direction(along), piece_mm));
  }
  return pieces * piece_mm;
}

} // namespace

VesselTree moved_tree(const VesselTree& tree, const pipeline::RigidTransform& motion) {
  VesselTree moved = tree;
  for (auto& at : moved.positions_mm) {
    const Point there = motion.apply({double{at[0]}, double{at[1]}, double{at[2]}});
    for (std::size_t axis = 0; axis < 3; ++axis)
      at[axis] = static_cast<float>(there[axis]);
  }
  return moved;
}

VesselTree imperfect_tree(const VesselTree& tree, const pipeline::PointBox& field,
                          const TraceFlaws& flaws, sim::HashRandom& random) {
  std::vector<std::uint32_t> children(tree.nodes());
  for (const std::uint32_t parent : tree.parents)
    if (parent != no_parent)
      ++children[parent];
  std::vector<Point> errors(tree.nodes());
  std::vector<bool> missed(tree.nodes());
  std::vector<std::uint32_t> found(tree.nodes(), no_parent); // index in the tree that is made
  VesselTree made;
  double length_mm = 0;
  for (std::size_t node = 0; node < tree.nodes(); ++node) {
    const std::uint32_t parent = tree.parents[node];
    if (parent == no_parent)
      continue;
    const bool begins = children[parent] != 1 || tree.parents[parent] == no_parent;
    missed[node] = begins ? random.unit() < flaws.missing : missed[parent];
    errors[node] = next_error(errors[parent], flaws.off_mm, random);
    const Point from = place_of(tree, parent), to = place_of(tree, node);
    if (missed[node] || !field.contains(from) || !field.contains(to) ||
        double{tree.radii_mm[node]} < flaws.least_radius_mm)
      continue;
    if (found[parent] == no_parent)
      found[parent] =
          add_node(made, pipeline::sum(from, errors[parent]), tree.radii_mm[parent], no_parent);
    found[node] =
        add_node(made, pipeline::sum(to, errors[node]), tree.radii_mm[node], found[parent]);
    length_mm += pipeline::length(pipeline::difference(to, from));
  }
  for (double invented = 0; invented < flaws.invented * length_mm;)
    invented += add_invented(made, field, random);
  return made;
}

} // namespace octascope::firmware_host
