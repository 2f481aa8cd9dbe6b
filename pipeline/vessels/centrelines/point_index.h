// Finds the points in a box: a k-d tree over fixed points.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "pipeline/vessels/centrelines/segment_geometry.h"

namespace octascope::pipeline {

class PointIndex {
public:
  explicit PointIndex(std::vector<Position> points)
      : points_{std::move(points)}, order_(points_.size()) {
    std::iota(order_.begin(), order_.end(), 0U);
    build(order_, 0);
  }

  // Calls take(index) for each point within `reach` of the box, on each axis.
  template <class Take>
  void for_each_near(const Position& lowest, const Position& highest, double reach,
                     const Take& take) const {
    visit(order_, 0, {lowest, highest, reach}, take);
  }

private:
  struct Box {
    const Position &lowest, &highest;
    double reach;

    bool begins_below(double c, std::size_t axis) const { return lowest[axis] - reach <= c; }
    bool ends_above(double c, std::size_t axis) const { return highest[axis] + reach >= c; }
  };

  // The middle point splits the rest; those before it are no greater on the axis.
  void build(std::span<std::uint32_t> part, std::size_t axis) {
    if (part.size() < 2)
      return;
    const std::size_t middle = part.size() / 2;
    std::ranges::nth_element(part, part.begin() + static_cast<std::ptrdiff_t>(middle), {},
                             [&](std::uint32_t i) { return points_[i][axis]; });
    build(part.first(middle), (axis + 1) % 3);
    build(part.subspan(middle + 1), (axis + 1) % 3);
  }

  template <class Take>
  void visit(std::span<const std::uint32_t> part, std::size_t axis, const Box& box,
             const Take& take) const {
    if (part.empty())
      return;
    const std::size_t middle = part.size() / 2;
    const Position& at = points_[part[middle]];
    const std::size_t next = (axis + 1) % 3;
    if (box.begins_below(at[axis], axis))
      visit(part.first(middle), next, box, take);
    if (box.begins_below(at[0], 0) && box.ends_above(at[0], 0) && box.begins_below(at[1], 1) &&
        box.ends_above(at[1], 1) && box.begins_below(at[2], 2) && box.ends_above(at[2], 2))
      take(part[middle]);
    if (box.ends_above(at[axis], axis))
      visit(part.subspan(middle + 1), next, box, take);
  }

  std::vector<Position> points_;
  std::vector<std::uint32_t> order_;
};

} // namespace octascope::pipeline
