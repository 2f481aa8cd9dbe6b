#include "pipeline/vessels/tracing/voxel_paths.h"

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <utility>

#include "pipeline/vessels/stoppable.h"
#include "pipeline/vessels/vectors.h"

namespace octascope::pipeline {

namespace {

constexpr std::uint32_t no_path = VoxelPath::no_path;

class PathFinder {
public:
  PathFinder(const FlowingVoxels& voxels, const FlowGrid& grid, const std::vector<float>& wall_um,
             const std::stop_token& stop);

  std::vector<VoxelPath> find();

private:
  struct Step {
    std::ptrdiff_t cells;
    float length_um;
  };
  using Reached = std::pair<float, std::uint32_t>; // cost or distance, voxel
  struct Node {
    float cost = std::numeric_limits<float>::infinity();
    float half_price = 0;   // of a step from it or to it, a µm
    float travelled_um = 0; // from the root
    std::uint32_t before = 0;
  };

  void spread(std::uint32_t root);
  void trace(std::uint32_t begin, std::uint32_t end, std::uint32_t root);
  bool is_branch(const VoxelPath& path) const;
  void cover(const VoxelPath& path);

  const FlowingVoxels& voxels_;
  const std::vector<float>& wall_um_;
  const std::stop_token& stop_;
  StopCheck stopped_{stop_};
  double widest_um_;
  std::array<Step, 26> steps_{};
  std::vector<Reached> heap_;
  std::vector<Node> nodes_; // by voxel
  std::vector<std::uint32_t> path_of_;
  std::vector<bool> covered_;
  std::vector<VoxelPath> paths_;
};

PathFinder::PathFinder(const FlowingVoxels& voxels, const FlowGrid& grid,
                       const std::vector<float>& wall_um, const std::stop_token& stop)
    : voxels_{voxels}, wall_um_{wall_um}, stop_{stop}, widest_um_{grid.widest_um()},
      nodes_(voxels.size()), path_of_(voxels.size(), no_path), covered_(voxels.size()) {
  for (std::size_t voxel = 0; voxel < voxels.size(); ++voxel)
    nodes_[voxel].half_price = 0.5F / (wall_um[voxel] * wall_um[voxel]);
  const auto [step_x, step_y, step_z] = voxels.steps();
  std::size_t n = 0;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x)
      for (int z = -1; z <= 1; ++z)
        if (x != 0 || y != 0 || z != 0)
          steps_[n++] = {x * step_x + y * step_y + z * step_z,
                         static_cast<float>(length({x * grid.spacing_um[0], y * grid.spacing_um[1],
                                                    z * grid.spacing_um[2]}))};
}

std::vector<VoxelPath> PathFinder::find() {
  const std::vector<std::uint32_t>& components = voxels_.components();
  for (std::size_t i = 0; i + 1 < components.size() && !stop_.stop_requested(); ++i) {
    const std::uint32_t root = components[i + 1] - 1; // an end: farthest from the first
    spread(root);
    trace(components[i], components[i + 1], root);
  }
  return std::move(paths_);
}

// Dijkstra's shortest paths.
void PathFinder::spread(std::uint32_t root) {
  const auto less = std::greater<>{};
  nodes_[root].cost = 0;
  nodes_[root].before = root;
  heap_.assign(1, {0.0F, root});
  while (!heap_.empty()) {
    std::ranges::pop_heap(heap_, less);
    const auto [cost, voxel] = heap_.back();
    heap_.pop_back();
    const Node from = nodes_[voxel];
    if (cost > from.cost)
      continue;
    if (stopped_())
      return;
    const auto cell = static_cast<std::ptrdiff_t>(voxels_.cell_of(voxel));
    for (const Step& step : steps_) {
      const std::uint32_t next = voxels_.voxel_at(static_cast<std::size_t>(cell + step.cells));
      if (next == FlowingVoxels::none)
        continue;
      Node& to = nodes_[next];
      const float there = cost + step.length_um * (from.half_price + to.half_price);
      if (there >= to.cost)
        continue;
      to.cost = there;
      to.before = voxel;
      to.travelled_um = from.travelled_um + step.length_um;
      heap_.emplace_back(there, next);
      std::ranges::push_heap(heap_, less);
    }
  }
}

void PathFinder::trace(std::uint32_t begin, std::uint32_t end, std::uint32_t root) {
  std::vector<Reached> farthest;
  farthest.reserve(end - begin);
  for (std::uint32_t voxel = begin; voxel < end; ++voxel)
    farthest.emplace_back(nodes_[voxel].travelled_um, voxel);
  stoppable_sort(farthest, std::greater<>{}, stop_);
  bool first = true;
  for (const auto& [travelled, tip] : farthest) {
    if (covered_[tip])
      continue;
    if (stop_.stop_requested())
      return;
    VoxelPath path;
    std::uint32_t voxel = tip;
    for (; voxel != root && path_of_[voxel] == no_path; voxel = nodes_[voxel].before)
      path.voxels.push_back(voxel);
    path.voxels.push_back(voxel);
    std::ranges::reverse(path.voxels);
    path.from = path_of_[voxel];
    cover(path);
    if (!first && !is_branch(path))
      continue;
    first = false;
    for (const std::uint32_t on : path.voxels)
      if (path_of_[on] == no_path)
        path_of_[on] = static_cast<std::uint32_t>(paths_.size());
    paths_.push_back(std::move(path));
  }
}

bool PathFinder::is_branch(const VoxelPath& path) const {
  const std::uint32_t fork = path.voxels.front();
  const std::uint32_t tip = path.voxels.back();
  const Point from = voxels_.middle_um(fork);
  float own_um = 0;
  for (const std::uint32_t voxel : path.voxels)
    if (length(difference(voxels_.middle_um(voxel), from)) > static_cast<double>(wall_um_[fork]))
      own_um = std::max(own_um, wall_um_[voxel]);
  const float free_um = nodes_[tip].travelled_um - nodes_[fork].travelled_um - wall_um_[fork];
  return free_um > std::max({2 * own_um, wall_um_[fork], static_cast<float>(1.2 * widest_um_)});
}

void PathFinder::cover(const VoxelPath& path) {
  for (const std::uint32_t voxel : path.voxels) {
    const double reach = 1.5 * static_cast<double>(wall_um_[voxel]) + 0.6 * widest_um_;
    voxels_.within(voxels_.middle_um(voxel), reach,
                   [&](std::uint32_t near, const Point&) { covered_[near] = true; });
    if (stopped_())
      return;
  }
}

} // namespace

std::vector<VoxelPath> find_voxel_paths(const FlowingVoxels& voxels, const FlowGrid& grid,
                                        const std::vector<float>& wall_um,
                                        const std::stop_token& stop) {
  return PathFinder{voxels, grid, wall_um, stop}.find();
}

} // namespace octascope::pipeline
