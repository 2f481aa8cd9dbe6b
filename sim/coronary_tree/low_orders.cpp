#include "sim/coronary_tree/low_orders.h"

#include <algorithm>

namespace octascope::sim {
namespace {

using Beginnings = std::array<std::array<std::size_t, lowest_trunk_order>, 3>;

// `kept` of the lowest order's elements are there; a whole one has its full size.
double total(const Beginnings& beginnings, const LowOrders& low) {
  double sum = 0;
  for (std::size_t b = 0; b < coronary_branches.size(); ++b) {
    const CrownSizes sizes = crown_sizes(morphometry(coronary_branches[b]), low);
    for (std::size_t order = low.lowest_order; order < lowest_trunk_order; ++order)
      sum += static_cast<double>(beginnings[b][order]) * sizes[order] *
             (order == low.lowest_order ? low.kept : 1);
  }
  return sum;
}

} // namespace

double LowOrders::factor(std::size_t order) const {
  if (order + 1 >= lowest_trunk_order)
    return order == lowest_order ? kept : 1;
  if (order < lowest_order)
    return 0;
  double result = order == lowest_order ? kept : 1;
  for (std::size_t i = order; i + 1 < lowest_trunk_order; ++i)
    result *= growth;
  return result;
}

double segments_per_element(const BranchMorphometry& branch, const LowOrders& low,
                            std::size_t order) {
  const double published = branch.orders[order].segments_per_element.mean;
  return order == 0 ? published : (published + 1) * low.growth - 1;
}

CrownSizes crown_sizes(const BranchMorphometry& branch, const LowOrders& low) {
  CrownSizes sizes{};
  for (std::size_t order = low.lowest_order; order < sizes.size(); ++order) {
    double size = segments_per_element(branch, low, order);
    for (std::size_t daughter = low.lowest_order; daughter < order; ++daughter)
      size += low.growth * branch.daughters[daughter][order] * sizes[daughter] *
              (daughter == low.lowest_order ? low.kept : 1);
    const double own_kind = order == low.lowest_order && low.kept < 1 ? low.kept : 1;
    sizes[order] = size / (1 - own_kind * low.growth * branch.daughters[order][order]);
  }
  return sizes;
}

LowOrders fit_low_orders(const Beginnings& beginnings, double segments) {
  LowOrders low;
  const auto bisect = [&](double& value, double least, double most) {
    for (int i = 0; i < 60; ++i) {
      value = (least + most) / 2;
      (total(beginnings, low) < segments ? least : most) = value;
    }
  };
  if (total(beginnings, low) < segments) {
    bisect(low.growth, 1, 2);
    return low;
  }
  while (low.lowest_order + 1 < lowest_trunk_order) {
    LowOrders without = low;
    ++without.lowest_order;
    if (total(beginnings, without) <= segments)
      break;
    low = without;
  }
  bisect(low.kept, 0, 1);
  return low;
}

double measured_growth(const pipeline::VesselTree& tree) {
  Beginnings beginnings{};
  double segments = 0;
  for (std::size_t i = 0; i < tree.nodes(); ++i) {
    const std::uint32_t parent = tree.parents[i];
    const std::size_t order = tree.orders[i];
    const auto* branch = std::ranges::find(coronary_branches, tree.branches[i]);
    if (parent == pipeline::no_parent || order >= lowest_trunk_order ||
        branch == coronary_branches.end())
      continue;
    ++segments;
    if (tree.orders[parent] >= lowest_trunk_order)
      ++beginnings[static_cast<std::size_t>(branch - coronary_branches.begin())][order];
  }
  return fit_low_orders(beginnings, segments).growth;
}

} // namespace octascope::sim
