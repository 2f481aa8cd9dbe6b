#include "pipeline/vessels/tree_summary.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace octascope::pipeline {
namespace {

double distance_mm(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  return std::hypot(double{a[0]} - double{b[0]}, double{a[1]} - double{b[1]},
                    double{a[2]} - double{b[2]});
}

void add_segment(const VesselTree& tree, std::size_t node, TreeSummary& summary) {
  const double length_mm =
      distance_mm(tree.positions_mm[node], tree.positions_mm[tree.parents[node]]);
  OrderSummary& order = summary.orders[tree.orders[node]];
  ++order.segments;
  order.length_mm += length_mm;
  order.mean_diameter_mm += 2 * double{tree.radii_mm[node]}; // the sum, so far
  ++summary.branches[static_cast<std::size_t>(tree.branches[node])];
  ++summary.segments;
  summary.length_mm += length_mm;
}

} // namespace

TreeSummary summarise(const VesselTree& tree) {
  TreeSummary summary;
  if (tree.nodes() == 0)
    return summary;
  summary.nodes = tree.nodes();
  summary.lowest_mm = summary.highest_mm = tree.positions_mm.front();
  std::vector<std::uint8_t> children(tree.nodes(), 0); // up to 2
  for (std::size_t i = 0; i < tree.nodes(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      summary.lowest_mm[axis] = std::min(summary.lowest_mm[axis], tree.positions_mm[i][axis]);
      summary.highest_mm[axis] = std::max(summary.highest_mm[axis], tree.positions_mm[i][axis]);
    }
    const std::uint32_t parent = tree.parents[i];
    if (parent == no_parent) {
      ++summary.roots;
      continue;
    }
    if (children[parent] < 2)
      ++children[parent];
    add_segment(tree, i, summary);
  }
  summary.branch_points = static_cast<std::uint64_t>(std::ranges::count(children, 2));
  summary.tips = static_cast<std::uint64_t>(std::ranges::count(children, 0));
  for (OrderSummary& order : summary.orders)
    order.mean_diameter_mm /= static_cast<double>(std::max<std::uint64_t>(order.segments, 1));
  const auto [smallest, largest] = std::ranges::minmax_element(tree.radii_mm);
  summary.smallest_radius_mm = *smallest;
  summary.largest_radius_mm = *largest;
  return summary;
}

} // namespace octascope::pipeline
