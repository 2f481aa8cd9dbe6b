#include "sim/coronary_tree/morphometry_table.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

namespace octascope::sim {
namespace {

struct Sums {
  double count = 0;
  double sum = 0;
  double squares = 0;

  void add(double value) {
    ++count;
    sum += value;
    squares += value * value;
  }
  double mean() const { return count > 0 ? sum / count : 0; }
  double deviation() const {
    return count > 0 ? std::sqrt(std::max(0.0, squares / count - mean() * mean())) : 0;
  }
};

struct OrderSums {
  Sums diameter_um;
  Sums length_mm;
  Sums segments_per_element;
};

std::size_t place_of(pipeline::VesselBranch branch) {
  return branch == pipeline::VesselBranch::lcx ? 2 : branch == pipeline::VesselBranch::lad ? 1 : 0;
}

double length_of(const pipeline::VesselTree& tree, std::size_t node) {
  const auto& a = tree.positions_mm[node];
  const auto& b = tree.positions_mm[tree.parents[node]];
  double squares = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const double d = static_cast<double>(a[i]) - static_cast<double>(b[i]);
    squares += d * d;
  }
  return std::sqrt(squares);
}

bool is_root(const pipeline::VesselTree& tree, std::size_t node) {
  return tree.parents[node] == pipeline::no_parent;
}

// Of each node the daughter of its own order that goes on with its element; no_parent: none.
std::vector<std::uint32_t> continuations(const pipeline::VesselTree& tree) {
  std::vector<std::uint32_t> next(tree.nodes(), pipeline::no_parent);
  for (std::uint32_t i = 0; i < tree.nodes(); ++i) {
    if (is_root(tree, i))
      continue;
    const std::uint32_t parent = tree.parents[i];
    if (tree.orders[parent] != tree.orders[i])
      continue;
    std::uint32_t& best = next[parent];
    if (best == pipeline::no_parent || tree.radii_mm[i] > tree.radii_mm[best])
      best = i;
  }
  return next;
}

using AllSums = std::array<std::array<OrderSums, pipeline::vessel_order_count>, 3>;

AllSums measure(const pipeline::VesselTree& tree) {
  AllSums sums{};
  const std::vector<std::uint32_t> next = continuations(tree);
  for (std::uint32_t i = 0; i < tree.nodes(); ++i) {
    if (is_root(tree, i))
      continue;
    OrderSums& of = sums[place_of(tree.branches[i])][tree.orders[i]];
    of.diameter_um.add(2000 * static_cast<double>(tree.radii_mm[i]));
    of.length_mm.add(length_of(tree, i));
    const std::uint32_t parent = tree.parents[i];
    const bool begins = is_root(tree, parent) || next[parent] != i;
    if (!begins)
      continue;
    std::size_t segments = 1;
    for (std::uint32_t at = next[i]; at != pipeline::no_parent; at = next[at])
      ++segments;
    of.segments_per_element.add(static_cast<double>(segments));
  }
  return sums;
}

double murray_ratio(const pipeline::VesselTree& tree) {
  constexpr double widest_mm = 0.025; // radius
  std::vector<float> daughters(tree.nodes(), 0.0F);
  std::vector<std::uint8_t> count(tree.nodes(), 0);
  const auto cube = [](float r) { return r * r * r; };
  for (std::size_t i = 0; i < tree.nodes(); ++i)
    if (!is_root(tree, i)) {
      daughters[tree.parents[i]] += cube(tree.radii_mm[i]);
      ++count[tree.parents[i]];
    }
  Sums ratios;
  for (std::size_t i = 0; i < tree.nodes(); ++i)
    if (count[i] == 2 && !is_root(tree, i) && static_cast<double>(tree.radii_mm[i]) < widest_mm)
      ratios.add(static_cast<double>(daughters[i] / cube(tree.radii_mm[i])));
  return ratios.mean();
}

Comparison compared(const Sums& sums, const MeanAndDeviation& published) {
  Comparison c{sums.mean(), sums.deviation(), published.mean, published.deviation, 0};
  if (published.deviation > 0)
    c.z = (c.achieved - c.published) / published.deviation;
  return c;
}

// Order 0 was not counted: what its published mothers have.
MeanAndDeviation published_elements(const BranchMorphometry& facts, std::size_t order) {
  if (order > 0)
    return facts.orders[order].elements;
  MeanAndDeviation result;
  double squares = 0;
  for (std::size_t mother = 1; mother < lowest_trunk_order; ++mother) {
    result.mean += facts.daughters[0][mother] * facts.orders[mother].elements.mean;
    const double error = facts.daughters[0][mother] * facts.orders[mother].elements.deviation;
    squares += error * error;
  }
  result.deviation = std::sqrt(squares);
  return result;
}

OrderComparison compare_order(const OrderSums& sums, const BranchMorphometry& facts,
                              std::size_t order, double factor) {
  OrderComparison result;
  result.present = sums.diameter_um.count > 0;
  result.factor = factor;
  result.segments = static_cast<std::size_t>(sums.diameter_um.count);
  const OrderMorphometry& published = facts.orders[order];
  result.diameter_um = compared(sums.diameter_um, published.diameter_um);
  result.length_mm = compared(sums.length_mm, published.length_mm);
  result.segments_per_element = compared(sums.segments_per_element, published.segments_per_element);
  const MeanAndDeviation elements = published_elements(facts, order);
  Comparison& e = result.elements;
  e.achieved = sums.segments_per_element.count;
  e.published = elements.mean;
  e.published_deviation = elements.deviation;
  if (elements.deviation > 0 && factor > 0)
    e.z = (e.achieved - factor * e.published) / (factor * elements.deviation);
  return result;
}

LowOrders measured_low_orders(const pipeline::VesselTree& tree, const AllSums& sums) {
  LowOrders low;
  low.growth = measured_growth(tree);
  for (std::size_t order = 0; order < lowest_trunk_order; ++order) {
    double found = 0;
    double published = 0;
    for (std::size_t b = 0; b < sums.size(); ++b) {
      found += sums[b][order].segments_per_element.count;
      published += published_elements(morphometry(coronary_branches[b]), order).mean;
    }
    if (found == 0)
      continue;
    low.lowest_order = order;
    low.kept = low.growth > 1 ? 1 : std::min(1.0, found / published);
    break;
  }
  return low;
}

MorphometryTable compare(const pipeline::VesselTree& tree, const AllSums& sums,
                         const LowOrders& low) {
  MorphometryTable table;
  double segments = 0;
  double published_segments = 0;
  for (std::size_t b = 0; b < 3; ++b) {
    const BranchMorphometry& facts = morphometry(coronary_branches[b]);
    for (std::size_t order = 0; order <= facts.highest_order; ++order) {
      const double factor = order < lowest_trunk_order ? low.factor(order) : 1;
      table.branches[b][order] = compare_order(sums[b][order], facts, order, factor);
      segments += sums[b][order].diameter_um.count;
      published_segments +=
          published_elements(facts, order).mean * facts.orders[order].segments_per_element.mean;
    }
  }
  table.growth = low.growth;
  table.whole_factor = segments / published_segments;
  table.murray_ratio = murray_ratio(tree);
  return table;
}

} // namespace

MorphometryTable compare_with_published(const CoronaryTree& coronary) {
  return compare(coronary.tree, measure(coronary.tree), coronary.low);
}

MorphometryTable compare_with_published(const pipeline::VesselTree& tree) {
  const AllSums sums = measure(tree);
  return compare(tree, sums, measured_low_orders(tree, sums));
}

std::string to_text(const MorphometryTable& table) {
  static constexpr std::array<const char*, 3> names{"RCA", "LAD", "LCX"};
  std::string text;
  const auto out = std::back_inserter(text);
  fmt::format_to(out,
                 "Achieved (published) z. z: in published standard deviations; elements: in "
                 "published standard errors,\nagainst the published number times the factor.\n\n"
                 "          diameter, um              segment, mm              segments/element    "
                 "  elements                   factor\n");
  for (std::size_t b = 0; b < 3; ++b)
    for (std::size_t order = pipeline::vessel_order_count; order-- > 0;) {
      const OrderComparison& o = table.branches[b][order];
      if (!o.present)
        continue;
      fmt::format_to(
          out,
          "{} {:>2}  {:8.1f} ({:6.1f}) {:+5.2f}  {:7.3f} ({:5.3f}) {:+5.2f}  {:6.2f} ({:5.2f}) "
          "{:+5.2f}  {:8.0f} ({:7.0f}) {:+5.2f}  {:5.3f}\n",
          names[b], order, o.diameter_um.achieved, o.diameter_um.published, o.diameter_um.z,
          o.length_mm.achieved, o.length_mm.published, o.length_mm.z,
          o.segments_per_element.achieved, o.segments_per_element.published,
          o.segments_per_element.z, o.elements.achieved, o.elements.published, o.elements.z,
          o.factor);
    }
  fmt::format_to(out,
                 "\nFactor: {:.3f} of the published segments in all; daughters of an element of "
                 "order 4 and lower: times {:.4f}\nMurray: daughters' D^3 / mother's D^3 = {:.3f} "
                 "below 50 um (published 1.03 to 1.05)\n",
                 table.whole_factor, table.growth, table.murray_ratio);
  return text;
}

} // namespace octascope::sim
