#include "pipeline/vessels/following/sample_grid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "pipeline/vessels/vectors.h"

namespace octascope::pipeline {

namespace {

constexpr double least_cosine = 0.82; // 35 degrees

} // namespace

SampleGrid::SampleGrid(std::span<const TreeSample> samples, double step_mm, const PointBox& box)
    : step_mm_{step_mm}, origin_{box.lower} {
  std::size_t cells = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cells_[axis] = 1 + static_cast<int>((box.upper[axis] - box.lower[axis]) / cell_mm);
    cells *= static_cast<std::size_t>(cells_[axis]);
  }
  first_.resize(cells + 1);
  for (const TreeSample& sample : samples)
    if (box.contains(sample.at))
      ++first_[index_of(cell_of(sample.at)) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  samples_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (const TreeSample& sample : samples)
    if (box.contains(sample.at))
      samples_[next[index_of(cell_of(sample.at))]++] = sample;
}

SampleGrid::Cell SampleGrid::cell_of(const Point& at) const {
  Cell cell{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    cell[axis] = static_cast<int>(std::floor((at[axis] - origin_[axis]) / cell_mm));
  return cell;
}

std::size_t SampleGrid::index_of(const Cell& cell) const {
  return static_cast<std::size_t>((cell[2] * cells_[1] + cell[1]) * cells_[0] + cell[0]);
}

std::optional<SampleGrid::Beside> SampleGrid::nearest(const Point& at, const Point& along,
                                                      double reach_mm) const {
  Cell low = cell_of(difference(at, {reach_mm, reach_mm, reach_mm}));
  Cell high = cell_of(sum(at, {reach_mm, reach_mm, reach_mm}));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    low[axis] = std::max(low[axis], 0);
    high[axis] = std::min(high[axis], cells_[axis] - 1);
    if (low[axis] > high[axis])
      return std::nullopt;
  }
  std::optional<Beside> best;
  double least = reach_mm * reach_mm;
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y) {
      const std::size_t row = index_of({low[0], y, z});
      const std::size_t end = row + static_cast<std::size_t>(high[0] - low[0]) + 1;
      for (std::uint32_t i = first_[row]; i < first_[end]; ++i) {
        const TreeSample& sample = samples_[i];
        const Point away = difference(at, sample.at);
        const double on = product(away, sample.along);
        const double past = std::max(0.0, std::fabs(on) - step_mm_); // of the piece's end
        const Point off = difference(away, scaled(sample.along, on));
        const double across = product(off, off);
        if (across + past * past >= least || std::fabs(product(along, sample.along)) < least_cosine)
          continue;
        least = across + past * past;
        best = Beside{&sample, off, std::sqrt(across)};
      }
    }
  return best;
}

} // namespace octascope::pipeline
