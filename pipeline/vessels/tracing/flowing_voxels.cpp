#include "pipeline/vessels/tracing/flowing_voxels.h"

#include <algorithm>

namespace octascope::pipeline {

namespace {

constexpr std::uint32_t candidate = FlowingVoxels::none - 1;
constexpr std::uint32_t seed = FlowingVoxels::none - 2;

bool flows(std::uint32_t mark) {
  return mark == candidate || mark == seed;
}

} // namespace

void FlowingVoxels::set_shape(const FlowGrid& grid) {
  counts_ = {grid.counts[0] + 2, grid.counts[1] + 2, grid.counts[2] + 2};
  spacing_um_ = grid.spacing_um;
  std::size_t n = 0;
  for (std::ptrdiff_t y = -1; y <= 1; ++y)
    for (std::ptrdiff_t x = -1; x <= 1; ++x)
      for (std::ptrdiff_t z = -1; z <= 1; ++z)
        if (x != 0 || y != 0 || z != 0)
          neighbours_[n++] = (y * counts_[0] + x) * counts_[2] + z;
}

void FlowingVoxels::find(const FlowGrid& grid, const FlowThresholds& thresholds,
                         const std::stop_token& stop) {
  set_shape(grid);
  cells_.clear();
  components_.assign(1, 0);
  all_flow_ = 0;
  voxel_of_.assign(static_cast<std::size_t>(counts_[0] * counts_[1] * counts_[2]), none);
  mark(grid, thresholds);
  fill_holes();
  for (std::size_t cell = 0; cell < voxel_of_.size(); ++cell) {
    if (voxel_of_[cell] != seed)
      continue;
    if (stop.stop_requested())
      return;
    flood(static_cast<std::uint32_t>(cell));
    const std::size_t begin = components_.back();
    if (cells_.size() - begin >= thresholds.fewest_voxels) {
      components_.push_back(static_cast<std::uint32_t>(cells_.size()));
      continue;
    }
    for (std::size_t i = begin; i < cells_.size(); ++i)
      voxel_of_[cells_[i]] = none;
    cells_.resize(begin);
  }
  std::ranges::replace(voxel_of_, candidate, none); // connected to no seed
}

void FlowingVoxels::mark(const FlowGrid& grid, const FlowThresholds& thresholds) {
  for (int y = 0; y < grid.counts[1]; ++y)
    for (int x = 0; x < grid.counts[0]; ++x) {
      const float* smooth = &grid.smooth[grid.at(x, y, 0)];
      const float* flow = &grid.flow[grid.at(x, y, 0)];
      std::uint32_t* to =
          &voxel_of_[static_cast<std::size_t>(((y + 1) * counts_[0] + x + 1) * counts_[2] + 1)];
      for (int z = 0; z < grid.counts[2]; ++z) {
        if (smooth[z] < thresholds.low)
          continue;
        to[z] = smooth[z] >= thresholds.high ? seed : candidate;
        all_flow_ += static_cast<double>(std::max(flow[z], 0.0F));
      }
    }
}

// A voxel between two that flow, at most two away, along the depth and across it, flows as well.
void FlowingVoxels::fill_holes() {
  const auto [step_x, step_y, step_z] = steps();
  std::vector<std::size_t> holes;
  for (std::ptrdiff_t y = 1; y < counts_[1] - 1; ++y)
    for (std::ptrdiff_t x = 2; x < counts_[0] - 2; ++x)
      for (std::ptrdiff_t z = 2; z < counts_[2] - 2; ++z) {
        const std::uint32_t* at = &voxel_of_[static_cast<std::size_t>(y * step_y + x * step_x + z)];
        const auto near = [&](std::ptrdiff_t step) {
          return flows(at[step]) || flows(at[2 * step]);
        };
        if (*at == none && near(step_z) && near(-step_z) && near(step_x) && near(-step_x))
          holes.push_back(static_cast<std::size_t>(at - voxel_of_.data()));
      }
  for (const std::size_t cell : holes)
    voxel_of_[cell] = candidate;
}

void FlowingVoxels::flood(std::uint32_t cell) {
  std::size_t next = cells_.size();
  const auto take = [&](std::uint32_t taken) {
    voxel_of_[taken] = static_cast<std::uint32_t>(cells_.size());
    cells_.push_back(taken);
  };
  for (take(cell); next < cells_.size(); ++next)
    for (const std::ptrdiff_t step : neighbours_) {
      const auto neighbour = static_cast<std::uint32_t>(cells_[next] + step);
      if (flows(voxel_of_[neighbour]))
        take(neighbour);
    }
}

double FlowingVoxels::background_share(const FlowGrid& grid) const {
  double all = 0;
  std::size_t known = 0;
  for (const float flow : grid.flow) {
    all += static_cast<double>(std::max(flow, 0.0F));
    known += flow >= 0 ? 1 : 0;
  }
  double flowing = 0;
  for (std::uint32_t voxel = 0; voxel < size(); ++voxel)
    flowing += flow_of(grid, voxel);
  if (flowing <= 0)
    return 1;
  const double beside = static_cast<double>(known) - static_cast<double>(size());
  return beside <= 0 ? 1 : (all - flowing) / beside / (flowing / static_cast<double>(size()));
}

double FlowingVoxels::flow_of(const FlowGrid& grid, std::uint32_t voxel) const {
  const std::array<int, 3> at = place(voxel);
  return static_cast<double>(std::max(grid.flow[grid.at(at[0], at[1], at[2])], 0.0F));
}

std::uint32_t FlowingVoxels::voxel_around(const Point& at_um, const FlowGrid& grid) const {
  std::ptrdiff_t cell = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double place = std::floor(at_um[axis] / spacing_um_[axis]);
    if (!(place >= 0 && place < grid.counts[axis]))
      return none;
    cell += (static_cast<std::ptrdiff_t>(place) + 1) * steps()[axis];
  }
  return voxel_at(static_cast<std::size_t>(cell));
}

std::array<int, 3> FlowingVoxels::place(std::uint32_t voxel) const {
  const auto cell = static_cast<std::ptrdiff_t>(cells_[voxel]);
  const std::ptrdiff_t line = cell / counts_[2];
  return {static_cast<int>(line % counts_[0]) - 1, static_cast<int>(line / counts_[0]) - 1,
          static_cast<int>(cell % counts_[2]) - 1};
}

Point FlowingVoxels::middle_um(std::uint32_t voxel) const {
  const std::array<int, 3> at = place(voxel);
  return {(at[0] + 0.5) * spacing_um_[0], (at[1] + 0.5) * spacing_um_[1],
          (at[2] + 0.5) * spacing_um_[2]};
}

} // namespace octascope::pipeline
