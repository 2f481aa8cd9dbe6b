#include "pipeline/vessels/tracing/flow_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pipeline/volume/flow_scale.h"

namespace octascope::pipeline {

using hal::ErrorCode;

double FlowGrid::widest_um() const {
  return std::ranges::max(spacing_um);
}
double FlowGrid::narrowest_um() const {
  return std::ranges::min(spacing_um);
}

namespace {

hal::Result<> check_shape(const VolumeGeometry& g) {
  if (g.depths < 1 || g.a_scans < 1 || g.b_scans < 1)
    return hal::fail(ErrorCode::invalid_argument,
                     "found a flow volume of {} B-scans of {} A-scans of {} depths, expected at "
                     "least one of each",
                     g.b_scans, g.a_scans, g.depths);
  for (const double spacing : {g.depth_spacing_um, g.a_spacing_um, g.b_spacing_um})
    if (!(spacing > 0 && spacing < 1e6))
      return hal::fail(ErrorCode::invalid_argument,
                       "found a spacing of {:g} µm in the flow volume, expected one above 0 µm and "
                       "below a metre",
                       spacing);
  return {};
}

// Cells have 32-bit numbers, a few of which are marks (flowing_voxels.h).
hal::Result<> check_cells(const FlowGrid& grid) {
  constexpr double most_cells = 0xFFFFFFF0;
  double cells = 1;
  for (const int count : grid.counts)
    cells *= count + 2.0;
  if (cells > most_cells)
    return hal::fail(
        ErrorCode::unsupported,
        "found {:.0f} cells of a volume of {} × {} × {} with a border around, expected "
        "at most {:.0f}: cut the volume",
        cells, grid.counts[1], grid.counts[0], grid.counts[2], most_cells);
  return {};
}

// How many voxels of each axis make one of the grid.
std::array<int, 3> voxels_together(const std::array<double, 3>& spacing_um) {
  std::array<double, 3> sorted = spacing_um;
  std::ranges::sort(sorted);
  std::array<int, 3> together{};
  for (std::size_t axis = 0; axis < 3; ++axis)
    together[axis] = std::clamp(static_cast<int>(std::lround(sorted[1] / spacing_um[axis])), 1, 64);
  return together;
}

constexpr float rounding = 0.01F;
constexpr float least_flow = -rounding;
constexpr float most_flow = 1 + rounding;

hal::Result<> check_values(std::span<const std::uint8_t>) {
  return {};
}
hal::Result<> check_values(std::span<const float> flow) {
  float lowest = 0;
  float highest = 0;
  for (const float value : flow)
    if (std::isfinite(value)) {
      lowest = std::min(lowest, value);
      highest = std::max(highest, value);
    }
  if (lowest >= least_flow && highest <= most_flow)
    return {};
  return hal::fail(ErrorCode::bad_data,
                   "found values from {:g} to {:g}, expected flow from 0 (static) to 1 (flowing), "
                   "NaN where it is unknown",
                   lowest, highest);
}

// Sums of lines along the depth, before and after several voxels become one.
class LineSums {
public:
  LineSums(std::size_t depths, int together)
      : together_{static_cast<std::size_t>(together)}, sums_(depths), told_(depths) {}

  void clear() {
    std::ranges::fill(sums_, 0.0F);
    std::ranges::fill(told_, 0.0F);
    lines_ = 0;
  }

  // Values beyond what flow can be count as unknown; false if there are any but NaN and infinity.
  bool add(std::span<const float> line) {
    int wrong = 0;
    for (std::size_t z = 0; z < line.size(); ++z) {
      const float value = line[z];
      const bool is_flow = value >= least_flow && value <= most_flow;
      const bool is_finite = std::fabs(value) <= std::numeric_limits<float>::max();
      sums_[z] += is_flow ? value : 0.0F;
      told_[z] += is_flow ? 1.0F : 0.0F;
      wrong |= is_finite && !is_flow ? 1 : 0;
    }
    ++lines_;
    return wrong == 0;
  }
  bool add(std::span<const std::uint8_t> line) {
    constexpr float unit = 1.0F / (flow_full - flow_static);
    for (std::size_t z = 0; z < line.size(); ++z) {
      sums_[z] +=
          static_cast<float>(std::max<std::uint8_t>(line[z], flow_static) - flow_static) * unit;
      told_[z] += line[z] != flow_untold ? 1.0F : 0.0F;
    }
    ++lines_;
    return true;
  }

  void write(std::span<float> to) const {
    for (std::size_t i = 0; i < to.size(); ++i) {
      const std::size_t begin = i * together_;
      const std::size_t end = std::min(begin + together_, sums_.size());
      float sum = 0;
      float told = 0;
      for (std::size_t z = begin; z < end; ++z) {
        sum += sums_[z];
        told += told_[z];
      }
      const auto voxels = static_cast<float>(end - begin) * lines_;
      to[i] = 2 * told >= voxels ? std::max(sum / told, 0.0F) : unknown_flow;
    }
  }

private:
  std::size_t together_;
  std::vector<float> sums_, told_;
  float lines_ = 0;
};

// False if a value is no flow.
template <class Value>
bool average(FlowGrid& grid, const VolumeGeometry& g, std::span<const Value> flow,
             const std::array<int, 3>& together) {
  const auto depths = static_cast<std::size_t>(g.depths);
  LineSums sums{depths, together[2]};
  bool right = true;
  for (int y = 0; y < grid.counts[1]; ++y)
    for (int x = 0; x < grid.counts[0]; ++x) {
      sums.clear();
      for (int b = y * together[1]; b < std::min(g.b_scans, (y + 1) * together[1]); ++b)
        for (int a = x * together[0]; a < std::min(g.a_scans, (x + 1) * together[0]); ++a) {
          const std::size_t line =
              static_cast<std::size_t>(b) * static_cast<std::size_t>(g.a_scans) +
              static_cast<std::size_t>(a);
          right = sums.add(flow.subspan(line * depths, depths)) && right;
        }
      sums.write(
          std::span{grid.flow}.subspan(grid.at(x, y, 0), static_cast<std::size_t>(grid.counts[2])));
    }
  return right;
}

std::span<float> row_of(FlowGrid& grid, int y) {
  const std::size_t size = grid.at(0, 1, 0);
  return std::span{grid.flow}.subspan(static_cast<std::size_t>(y) * size, size);
}

// `together`: B-scans of a row; the last row may have fewer of the `b_scans`.
void leave_out_moved(FlowGrid& grid, int together, int b_scans) {
  for (int y = 0; y < grid.counts[1]; ++y) {
    const std::span<float> row = row_of(grid, y);
    double sum = 0;
    std::size_t known = 0;
    for (const float value : row) {
      sum += static_cast<double>(std::max(value, 0.0F));
      known += value >= 0 ? 1 : 0;
    }
    if (known == 0)
      continue;
    const int in_row = std::min(together, b_scans - y * together);
    grid.told_b_scans += in_row;
    if (sum > most_flow_of_a_b_scan * static_cast<double>(known)) {
      grid.moved_b_scans += in_row;
      std::ranges::fill(row, unknown_flow);
    }
  }
}

// From the known ones alone, so that nothing spreads further.
void bridge_b_scans(FlowGrid& grid) {
  const std::size_t size = grid.at(0, 1, 0);
  std::vector<float> before2(size, unknown_flow);
  std::vector<float> before(size, unknown_flow);
  std::vector<float> now(size);
  for (int y = 0; y < grid.counts[1]; ++y) {
    const std::span<float> row = row_of(grid, y);
    std::ranges::copy(row, now.begin());
    const bool whole = std::ranges::find(row, unknown_flow) == row.end();
    for (std::size_t i = 0; i < size && !whole; ++i) {
      if (row[i] >= 0)
        continue;
      const float after = y + 1 < grid.counts[1] ? row_of(grid, y + 1)[i] : unknown_flow;
      const float after2 = y + 2 < grid.counts[1] ? row_of(grid, y + 2)[i] : unknown_flow;
      if (before[i] >= 0 && after >= 0)
        row[i] = (before[i] + after) / 2;
      else if (before[i] >= 0 && after2 >= 0)
        row[i] = (2 * before[i] + after2) / 3;
      else if (before2[i] >= 0 && after >= 0)
        row[i] = (before2[i] + 2 * after) / 3;
    }
    std::swap(before2, before);
    std::swap(before, now);
  }
}

// A row of weights ¼, ½, ¼ at neighbours `step` apart; none beyond the ends.
void smooth_row(std::span<const float> values, std::size_t step, std::span<float> to) {
  const std::size_t size = values.size();
  for (std::size_t i = 0; i < size; ++i)
    to[i] = 0.5F * values[i];
  for (std::size_t i = step; i < size; ++i) {
    to[i] += 0.25F * values[i - step];
    to[i - step] += 0.25F * values[i];
  }
}

void smooth(FlowGrid& grid) {
  const std::size_t size = grid.at(0, 1, 0);
  const auto line = static_cast<std::size_t>(grid.counts[2]);
  std::vector<float> values(size);
  std::vector<float> weights(size);
  std::vector<float> values_z(size);
  std::vector<float> weights_z(size);
  grid.smooth.resize(grid.flow.size());
  for (int y = 0; y < grid.counts[1]; ++y) {
    const std::span<const float> row = row_of(grid, y);
    for (std::size_t i = 0; i < size; ++i) {
      values[i] = std::max(row[i], 0.0F);
      weights[i] = row[i] >= 0 ? 1.0F : 0.0F;
    }
    for (std::size_t at = 0; at < size; at += line) {
      smooth_row(std::span{values}.subspan(at, line), 1, std::span{values_z}.subspan(at, line));
      smooth_row(std::span{weights}.subspan(at, line), 1, std::span{weights_z}.subspan(at, line));
    }
    smooth_row(values_z, line, values);
    smooth_row(weights_z, line, weights);
    float* to = &grid.smooth[grid.at(0, y, 0)];
    for (std::size_t i = 0; i < size; ++i)
      to[i] = weights[i] > 0 ? values[i] / weights[i] : unknown_flow;
  }
}

template <class Value>
hal::Result<> make_grid(const VolumeGeometry& g, std::span<const Value> flow, FlowGrid& grid) {
  HAL_CHECK(check_shape(g));
  const std::array<double, 3> spacing{g.a_spacing_um, g.b_spacing_um, g.depth_spacing_um};
  const std::array<int, 3> counts{g.a_scans, g.b_scans, g.depths};
  const std::array<int, 3> together = voxels_together(spacing);
  grid.told_b_scans = 0;
  grid.moved_b_scans = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grid.counts[axis] = (counts[axis] + together[axis] - 1) / together[axis];
    grid.spacing_um[axis] = spacing[axis] * together[axis];
  }
  HAL_CHECK(check_cells(grid));
  if (flow.size() != g.voxels())
    return hal::fail(ErrorCode::invalid_argument,
                     "found {} values of flow, expected {} = {} × {} × {}", flow.size(), g.voxels(),
                     g.b_scans, g.a_scans, g.depths);
  grid.flow.resize(grid.at(0, grid.counts[1], 0));
  if (!average(grid, g, flow, together))
    HAL_CHECK(check_values(flow));
  leave_out_moved(grid, together[1], g.b_scans);
  bridge_b_scans(grid);
  smooth(grid);
  return {};
}

} // namespace

hal::Result<> make_flow_grid(const VolumeGeometry& geometry, std::span<const float> flow,
                             FlowGrid& grid) {
  return make_grid(geometry, flow, grid);
}

hal::Result<> make_flow_grid(const VolumeGeometry& geometry, std::span<const std::uint8_t> counts,
                             FlowGrid& grid) {
  return make_grid(geometry, counts, grid);
}

} // namespace octascope::pipeline
