#include "pipeline/vessels/following/tree_samples.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "pipeline/vessels/vectors.h"

namespace octascope::pipeline {

namespace {

Point node_at(const VesselTree& tree, std::size_t node) {
  const std::array<float, 3>& at = tree.positions_mm[node];
  return {double{at[0]}, double{at[1]}, double{at[2]}};
}

// A vessel from one place to the next, as a line of nodes.
class SampledLine {
public:
  void clear() { nodes_.clear(); }
  void add(const Point& at, double radius_mm) {
    const double before = nodes_.empty() ? 0 : nodes_.back().way_mm;
    const double more = nodes_.empty() ? 0 : length(difference(at, nodes_.back().at));
    nodes_.push_back({at, radius_mm, before + more});
  }

  void sample(double step_mm, const PointBox& box, std::vector<TreeSample>& samples) const {
    if (nodes_.size() < 2 || nodes_.back().way_mm < step_mm)
      return;
    const double whole = nodes_.back().way_mm;
    const double pieces = std::round(whole / step_mm);
    const double piece = whole / pieces;
    for (double i = 0.5; i < pieces; ++i) {
      const Node at = node_after(i * piece);
      const Point before = node_after((i - 1.5) * piece).at;
      const Point after = node_after((i + 1.5) * piece).at;
      const Point along = direction(difference(after, before));
      if (box.contains(at.at) && product(along, along) > 0)
        samples.push_back({at.at, along, at.radius_mm, piece});
    }
  }

private:
  struct Node {
    Point at;
    double radius_mm;
    double way_mm; // from the beginning
  };

  // Between nodes; the ends beyond them.
  Node node_after(double way_mm) const {
    const double way = std::clamp(way_mm, 0.0, nodes_.back().way_mm);
    const auto next = std::ranges::lower_bound(nodes_, way, {}, &Node::way_mm);
    if (next == nodes_.begin())
      return nodes_.front();
    const Node& from = *(next - 1);
    const double share = (way - from.way_mm) / (next->way_mm - from.way_mm);
    return {sum(from.at, scaled(difference(next->at, from.at), share)),
            from.radius_mm + share * (next->radius_mm - from.radius_mm), way};
  }

  std::vector<Node> nodes_;
};

} // namespace

bool PointBox::contains(const Point& p) const {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (p[axis] < lower[axis] || p[axis] > upper[axis])
      return false;
  return true;
}

PointBox PointBox::grown(double by_mm) const {
  PointBox box = *this;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    box.lower[axis] -= by_mm;
    box.upper[axis] += by_mm;
  }
  return box;
}

Point PointBox::middle() const {
  return scaled(sum(lower, upper), 0.5);
}

double PointBox::longest_side() const {
  return std::ranges::max(difference(upper, lower));
}

PointBox box_around(const VesselTree& tree) {
  PointBox box{node_at(tree, 0), node_at(tree, 0)};
  for (std::size_t node = 0; node < tree.nodes(); ++node)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double at = node_at(tree, node)[axis];
      box.lower[axis] = std::min(box.lower[axis], at);
      box.upper[axis] = std::max(box.upper[axis], at);
    }
  return box;
}

std::vector<TreeSample> sample_tree(const VesselTree& tree, double step_mm,
                                    const RigidTransform& place, const PointBox& box) {
  constexpr std::uint32_t none = no_parent;
  constexpr std::uint32_t several = none - 1;
  std::vector<std::uint32_t> child(tree.nodes(), none);
  for (std::uint32_t node = 0; node < tree.nodes(); ++node)
    if (const std::uint32_t parent = tree.parents[node]; parent != no_parent)
      child[parent] = child[parent] == none ? node : several;

  std::vector<TreeSample> samples;
  SampledLine line;
  for (std::uint32_t first = 0; first < tree.nodes(); ++first) {
    const std::uint32_t parent = tree.parents[first];
    // A vessel begins at a root and behind each fork.
    if (parent == no_parent || (child[parent] != several && tree.parents[parent] != no_parent))
      continue;
    // What lies outside breaks it off: most of a large tree does.
    line.clear();
    Point before = place.apply(node_at(tree, parent));
    bool inside = box.contains(before);
    for (std::uint32_t node = first; node < several; node = child[node]) {
      const Point at = place.apply(node_at(tree, node));
      const bool now_inside = box.contains(at);
      if (inside || now_inside) {
        const auto radius_mm = double{tree.radii_mm[node]};
        if (!inside)
          line.clear();
        if (!inside || node == first)
          line.add(before, radius_mm);
        line.add(at, radius_mm);
        if (!now_inside)
          line.sample(step_mm, box, samples);
      }
      before = at;
      inside = now_inside;
    }
    if (inside)
      line.sample(step_mm, box, samples);
  }
  return samples;
}

} // namespace octascope::pipeline
