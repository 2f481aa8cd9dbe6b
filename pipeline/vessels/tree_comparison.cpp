#include "pipeline/vessels/tree_comparison.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "pipeline/vessels/rigid_transform.h"

namespace octascope::pipeline {

namespace {

Point point_of(const VesselTree& tree, std::size_t node) {
  const std::array<float, 3>& at = tree.positions_mm[node];
  return {static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
}

// A place on a tree.
struct TreePlace {
  Point at{};
  double radius_mm = 0;
};

TreePlace place_on(const VesselTree& tree, std::size_t node, double share) {
  const std::size_t parent = tree.parents[node];
  const Point from = point_of(tree, parent);
  const Point to = point_of(tree, node);
  TreePlace place;
  for (std::size_t axis = 0; axis < 3; ++axis)
    place.at[axis] = from[axis] + share * (to[axis] - from[axis]);
  const auto end = static_cast<double>(tree.radii_mm[node]);
  const auto start =
      static_cast<double>(segment_start_radius(tree.radii_mm[parent], tree.radii_mm[node]));
  place.radius_mm = start + share * (end - start);
  return place;
}

double apart(const Point& a, const Point& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

// Calls visit(place, length that it stands for) for places along all segments.
template <class Visit> void walk(const VesselTree& tree, double step_mm, const Visit& visit) {
  for (std::size_t node = 0; node < tree.nodes(); ++node) {
    if (tree.parents[node] == no_parent)
      continue;
    const double length = apart(point_of(tree, tree.parents[node]), point_of(tree, node));
    const auto places = static_cast<std::size_t>(std::ceil(length / step_mm));
    for (std::size_t i = 0; i < places; ++i)
      visit(place_on(tree, node, (static_cast<double>(i) + 0.5) / static_cast<double>(places)),
            length / static_cast<double>(places));
  }
}

// Segments of a tree by the cells that they may be near to.
class SegmentCells {
public:
  // Finds what is no farther than `reach_mm`.
  SegmentCells(const VesselTree& tree, double reach_mm) : tree_{tree}, reach_mm_{reach_mm} {
    for (std::size_t node = 0; node < tree.nodes(); ++node)
      if (tree.parents[node] != no_parent)
        add(static_cast<std::uint32_t>(node));
  }

  // The nearest place on the tree.
  std::optional<TreePlace> nearest(const Point& to) const {
    const auto cell = cells_.find(key_of(cell_of(to)));
    if (cell == cells_.end())
      return std::nullopt;
    std::optional<TreePlace> nearest;
    double least = reach_mm_;
    for (const std::uint32_t node : cell->second) {
      const TreePlace place = place_on(tree_, node, share_near(node, to));
      if (const double distance = apart(place.at, to); distance <= least) {
        least = distance;
        nearest = place;
      }
    }
    return nearest;
  }

private:
  using Cell = std::array<std::int64_t, 3>;

  Cell cell_of(const Point& at) const {
    Cell cell{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      cell[axis] = static_cast<std::int64_t>(std::floor(at[axis] / reach_mm_));
    return cell;
  }
  static std::uint64_t key_of(const Cell& cell) {
    constexpr std::uint64_t mask = (1U << 21) - 1;
    return (static_cast<std::uint64_t>(cell[0]) & mask) << 42 |
           (static_cast<std::uint64_t>(cell[1]) & mask) << 21 |
           (static_cast<std::uint64_t>(cell[2]) & mask);
  }
  double share_near(std::uint32_t node, const Point& to) const {
    const Point a = point_of(tree_, tree_.parents[node]);
    const Point b = point_of(tree_, node);
    double square = 0;
    double along = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      square += (b[axis] - a[axis]) * (b[axis] - a[axis]);
      along += (b[axis] - a[axis]) * (to[axis] - a[axis]);
    }
    return square > 0 ? std::clamp(along / square, 0.0, 1.0) : 0;
  }
  // To all cells around each place on it; places are no farther apart than a cell is wide.
  void add(std::uint32_t node) {
    const double length = apart(point_of(tree_, tree_.parents[node]), point_of(tree_, node));
    const auto places = static_cast<std::size_t>(std::ceil(2 * length / reach_mm_)) + 1;
    for (std::size_t i = 0; i <= places; ++i) {
      const Cell middle =
          cell_of(place_on(tree_, node, static_cast<double>(i) / static_cast<double>(places)).at);
      for (std::int64_t x = -1; x <= 1; ++x)
        for (std::int64_t y = -1; y <= 1; ++y)
          for (std::int64_t z = -1; z <= 1; ++z) {
            std::vector<std::uint32_t>& in =
                cells_[key_of({middle[0] + x, middle[1] + y, middle[2] + z})];
            if (in.empty() || in.back() != node)
              in.push_back(node);
          }
    }
  }

  const VesselTree& tree_;
  double reach_mm_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

AxisErrors errors_of(std::vector<double>& errors_mm) {
  if (errors_mm.empty())
    return {};
  std::ranges::sort(errors_mm);
  const auto quantile = [&](double share) {
    const double last = static_cast<double>(errors_mm.size() - 1);
    return errors_mm[static_cast<std::size_t>(std::lround(share * last))] * 1e3;
  };
  return {quantile(0.5), quantile(0.95), quantile(1)};
}

} // namespace

TreeComparison compare_trees(const VesselTree& found, const VesselTree& truth,
                             const ComparisonRules& rules) {
  const auto tolerance = static_cast<double>(rules.tolerance_mm);
  double reach = tolerance;
  for (const float radius : truth.radii_mm)
    reach = std::max(reach, static_cast<double>(radius) * static_cast<double>(widest_start));
  const SegmentCells true_cells{truth, reach};
  const SegmentCells found_cells{found, reach};
  const auto step = static_cast<double>(rules.step_mm);
  const auto same = [&](const TreePlace& true_place, const TreePlace& other) {
    return apart(true_place.at, other.at) <= std::max(tolerance, true_place.radius_mm);
  };
  const auto counts = [&](const TreePlace& true_place) {
    return true_place.radius_mm >= static_cast<double>(rules.least_radius_mm);
  };

  TreeComparison comparison;
  double length_found = 0;
  walk(truth, step, [&](const TreePlace& place, double length) {
    if (!counts(place))
      return;
    comparison.true_length_mm += length;
    const auto other = found_cells.nearest(place.at);
    length_found += other && same(place, *other) ? length : 0;
  });
  comparison.found_share =
      comparison.true_length_mm > 0 ? length_found / comparison.true_length_mm : 1;

  double invented = 0;
  std::array<std::vector<double>, 3> axes;
  std::vector<double> distances;
  double bias = 0;
  walk(found, step, [&](const TreePlace& place, double length) {
    comparison.found_length_mm += length;
    const auto other = true_cells.nearest(place.at);
    if (!other || !same(*other, place)) {
      invented += length;
      return;
    }
    if (!counts(*other))
      return;
    for (std::size_t axis = 0; axis < 3; ++axis)
      axes[axis].push_back(std::fabs(place.at[axis] - other->at[axis]));
    distances.push_back(apart(place.at, other->at));
    bias += place.radius_mm / other->radius_mm - 1;
  });
  comparison.invented_share =
      comparison.found_length_mm > 0 ? invented / comparison.found_length_mm : 0;
  comparison.radius_bias_share =
      distances.empty() ? 0 : bias / static_cast<double>(distances.size());
  for (std::size_t axis = 0; axis < 3; ++axis)
    comparison.axes[axis] = errors_of(axes[axis]);
  comparison.distance = errors_of(distances);
  return comparison;
}

} // namespace octascope::pipeline
