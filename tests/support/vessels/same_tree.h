// Is one tree the other, with its nodes in another order and a little moved?
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "pipeline/vessels/clusters/cluster_builder.h"
#include "pipeline/vessels/tree.h"

namespace octascope::tests {

class TreeComparison {
public:
  TreeComparison(const pipeline::VesselTree& expected, const pipeline::VesselTree& found)
      : expected_{expected}, found_{found} {}

  // From the roots up, children paired with children of paired parents. Quadratic in the number of
  // one node's children. Roots without children are left out. Returns what is wrong, or nothing.
  std::string run() {
    const Children found = children_of(found_);
    const Children expected = children_of(expected_); // last: whose roots count
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
    if (!pair_up(expected.back(), found.back(), pairs))
      return "the roots do not match";
    std::size_t segments = 0;
    while (!pairs.empty()) {
      const auto [e, f] = pairs.back();
      pairs.pop_back();
      const std::size_t before = pairs.size();
      if (!pair_up(expected[e], found[f], pairs))
        return "the children of node " + std::to_string(e) + " do not match";
      segments += pairs.size() - before;
    }
    return segments == expected_.nodes() - roots_ ? "" : "segments are missing";
  }

  // The greatest among paired nodes.
  pipeline::ClusterError error() const { return error_; }

private:
  using Children = std::vector<std::vector<std::uint32_t>>; // by node; the last are the roots

  Children children_of(const pipeline::VesselTree& tree) {
    Children children(tree.nodes() + 1);
    for (std::uint32_t i = 0; i < tree.nodes(); ++i)
      if (tree.parents[i] != pipeline::no_parent)
        children[tree.parents[i]].push_back(i);
    roots_ = 0;
    for (std::uint32_t i = 0; i < tree.nodes(); ++i)
      if (tree.parents[i] == pipeline::no_parent) {
        ++roots_;
        if (!children[i].empty())
          children.back().push_back(i);
      }
    return children;
  }

  static double kept(float radius) {
    return double{std::max(radius, pipeline::thinnest_vessel_mm)};
  }

  // In how far two nodes are one: place, radius, what is below.
  double difference(std::uint32_t e, std::uint32_t f) const {
    const auto& a = expected_.positions_mm[e];
    const auto& b = found_.positions_mm[f];
    double sum = std::fabs(std::log(kept(expected_.radii_mm[e]) / kept(found_.radii_mm[f])));
    for (std::size_t axis = 0; axis < 3; ++axis)
      sum += std::fabs(double{a[axis]} - double{b[axis]});
    const bool root = expected_.parents[e] == pipeline::no_parent;
    if (!root &&
        (expected_.orders[e] != found_.orders[f] || expected_.branches[e] != found_.branches[f]))
      return 1e9;
    return sum;
  }

  bool pair_up(const std::vector<std::uint32_t>& expected, std::vector<std::uint32_t> found,
               std::vector<std::pair<std::uint32_t, std::uint32_t>>& pairs) {
    if (expected.size() != found.size())
      return false;
    for (const std::uint32_t e : expected) {
      const auto best =
          std::min_element(found.begin(), found.end(), [&](std::uint32_t a, std::uint32_t b) {
            return difference(e, a) < difference(e, b);
          });
      if (difference(e, *best) >= 1e9)
        return false;
      note(e, *best);
      pairs.emplace_back(e, *best);
      *best = found.back();
      found.pop_back();
    }
    return true;
  }

  void note(std::uint32_t e, std::uint32_t f) {
    const auto& a = expected_.positions_mm[e];
    const auto& b = found_.positions_mm[f];
    const double distance = std::hypot(double{a[0]} - double{b[0]}, double{a[1]} - double{b[1]},
                                       double{a[2]} - double{b[2]});
    const double radius = kept(expected_.radii_mm[e]);
    error_.position_um = std::max(error_.position_um, static_cast<float>(1000 * distance));
    error_.relative_radius =
        std::max(error_.relative_radius,
                 static_cast<float>(std::fabs(double{found_.radii_mm[f]} - radius) / radius));
  }

  const pipeline::VesselTree& expected_;
  const pipeline::VesselTree& found_;
  std::size_t roots_ = 0;
  pipeline::ClusterError error_;
};

} // namespace octascope::tests
