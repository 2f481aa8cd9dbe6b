#include "sim/coronary_tree/spacing/tree_shape.h"

#include "sim/coronary_tree/spacing/segment_grid.h"
#include "sim/coronary_tree/spacing/segments.h"

namespace octascope::sim {
namespace {

bool crosses(const pipeline::VesselTree& tree, std::uint32_t a, std::uint32_t b) {
  const double both = static_cast<double>(tree.radii_mm[a]) + static_cast<double>(tree.radii_mm[b]);
  const Vector3 apart = nearest_approach(segment_line(tree, a), segment_line(tree, b)).apart;
  return dot(apart, apart) < 0.81 * both * both && !near_along_tree(tree, a, b, 3 * both);
}

void count_crossings(const pipeline::VesselTree& tree, TreeShape& shape) {
  std::vector<bool> crossing(tree.nodes(), false);
  const SegmentGrid grid{tree, 1};
  std::vector<std::uint32_t> near;
  for (std::uint32_t i = 0; i < tree.nodes(); ++i)
    if (tree.parents[i] != pipeline::no_parent) {
      ++shape[tree.orders[i]].segments;
      grid.find_near(tree, i, near);
      for (const std::uint32_t other : near)
        if ((!crossing[i] || !crossing[other]) && crosses(tree, i, other))
          crossing[i] = crossing[other] = true;
    }
  for (std::uint32_t i = 0; i < tree.nodes(); ++i)
    shape[tree.orders[i]].crossing += crossing[i];
}

void measure_turns(const pipeline::VesselTree& tree, TreeShape& shape) {
  constexpr double degrees = 57.29577951308232;
  const std::vector<std::uint32_t> widest = widest_daughters(tree);
  for (std::uint32_t i = 0; i < tree.nodes(); ++i) {
    if (tree.parents[i] == pipeline::no_parent || widest[i] == pipeline::no_parent)
      continue;
    const Line in = segment_line(tree, i);
    const Line out = segment_line(tree, widest[i]);
    const Vector3 before = unit(in.to - in.from, {1, 0, 0});
    const Vector3 after = unit(out.to - out.from, before);
    const double turn = degrees * std::acos(std::clamp(dot(before, after), -1.0, 1.0));
    OrderShape& of = shape[tree.orders[i]];
    ++of.bends;
    of.mean_turn_degrees += turn;
    of.sharp_turns += turn > 45;
  }
  for (OrderShape& of : shape)
    if (of.bends > 0)
      of.mean_turn_degrees /= static_cast<double>(of.bends);
}

} // namespace

std::vector<std::uint32_t> widest_daughters(const pipeline::VesselTree& tree) {
  std::vector<std::uint32_t> widest(tree.nodes(), pipeline::no_parent);
  for (std::uint32_t i = 0; i < tree.nodes(); ++i) {
    if (tree.parents[i] == pipeline::no_parent)
      continue;
    std::uint32_t& best = widest[tree.parents[i]];
    if (best == pipeline::no_parent || tree.radii_mm[i] > tree.radii_mm[best])
      best = i;
  }
  return widest;
}

TreeShape shape_of(const pipeline::VesselTree& tree) {
  TreeShape shape{};
  count_crossings(tree, shape);
  measure_turns(tree, shape);
  return shape;
}

} // namespace octascope::sim
