// Finds the vessel beside a place: samples of a tree by the cell that they lie in.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/vessels/following/tree_samples.h"

namespace octascope::pipeline {

class SampleGrid {
public:
  // Samples are `step_mm` apart. Those within `box` alone are taken; 4 bytes a cell.
  SampleGrid(std::span<const TreeSample> samples, double step_mm, const PointBox& box);

  struct Beside {
    const TreeSample* sample = nullptr;
    Point off{};            // from the vessel's line to the place, across the vessel
    double distance_mm = 0; // its length
  };

  // The nearest vessel that runs in about the direction `along`, to within 35 degrees; none within
  // `reach_mm`: empty.
  std::optional<Beside> nearest(const Point& at, const Point& along, double reach_mm) const;

private:
  static constexpr double cell_mm = 0.1;
  using Cell = std::array<int, 3>;

  Cell cell_of(const Point& at) const; // may lie outside
  std::size_t index_of(const Cell& cell) const;

  double step_mm_;
  Point origin_{};
  Cell cells_{}; // by axis
  std::vector<TreeSample> samples_;
  std::vector<std::uint32_t> first_; // by cell, and the end
};

} // namespace octascope::pipeline
