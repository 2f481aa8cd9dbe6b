#include "pipeline/vessels/tracing/branch_sampling.h"

#include <algorithm>
#include <cmath>

#include "pipeline/vessels/vectors.h"

namespace octascope::pipeline {

namespace {

// How far it is through a voxel in a direction.
double voxel_along(const Point& way, const FlowGrid& grid) {
  double square = 0;
  for (std::size_t axis = 0; axis < 3; ++axis)
    square += way[axis] * way[axis] / (grid.spacing_um[axis] * grid.spacing_um[axis]);
  return square > 0 ? 1 / std::sqrt(square) : grid.narrowest_um();
}

// The means of neighbours: steps of whole voxels are no directions.
std::vector<Point> softened(const std::vector<Point>& points) {
  std::vector<Point> soft = points;
  for (int turn = 0; turn < 2; ++turn) {
    const std::vector<Point> last = soft;
    for (std::size_t i = 1; i + 1 < last.size(); ++i)
      soft[i] = sum(scaled(last[i], 0.5), scaled(sum(last[i - 1], last[i + 1]), 0.25));
  }
  return soft;
}

// Takes away what is nearer to the last point than the wall is to it.
void trim_end(std::vector<Point>& points, std::vector<double>& radii) {
  if (points.empty())
    return;
  const Point tip = points.back();
  while (!points.empty() && length(difference(points.back(), tip)) < radii.back()) {
    points.pop_back();
    radii.pop_back();
  }
}

void trim_begin(std::vector<Point>& points, std::vector<double>& radii) {
  std::ranges::reverse(points);
  std::ranges::reverse(radii);
  trim_end(points, radii);
  std::ranges::reverse(points);
  std::ranges::reverse(radii);
}

// Whether a vessel of this radius is there.
bool is_inside(const Point& at, double radius, const FlowingVoxels& voxels, const FlowGrid& grid,
               const std::vector<float>& wall_um) {
  constexpr double least_share = 0.6;
  const std::uint32_t voxel = voxels.voxel_around(at, grid);
  return voxel != FlowingVoxels::none &&
         static_cast<double>(wall_um[voxel]) >= least_share * radius;
}

void extend_end(VesselLine& line, const FlowingVoxels& voxels, const FlowGrid& grid,
                const std::vector<float>& wall_um) {
  const std::size_t last = line.points.size() - 1;
  const Point way = direction(difference(line.points[last], line.points[last > 1 ? last - 2 : 0]));
  const double radius = line.radii[last];
  const double step = grid.narrowest_um() / 2;
  double reach = 0;
  while (reach < 2 * radius && is_inside(sum(line.points[last], scaled(way, reach + step)), radius,
                                         voxels, grid, wall_um))
    reach += step;
  if (reach == 0)
    return;
  line.points.push_back(sum(line.points[last], scaled(way, reach)));
  line.radii.push_back(radius);
}

void sample(VesselLine& line, const std::vector<Point>& points, const std::vector<double>& radii,
            const FlowGrid& grid) {
  double since = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    double apart = 0;
    if (i > 0) {
      const Point step = difference(points[i], points[i - 1]);
      since += length(step);
      apart = std::max(radii[i], voxel_along(direction(step), grid));
    }
    const bool last = i + 1 == points.size();
    if (last && line.points.size() > 1 &&
        since < apart / 2) { // one point for two that are too close
      line.points.pop_back();
      line.radii.pop_back();
    }
    if (i == 0 || last || since >= apart) {
      line.points.push_back(points[i]);
      line.radii.push_back(radii[i]);
      since = 0;
    }
  }
}

} // namespace

std::size_t nearest_point(const VesselLine& line, const Point& to) {
  std::size_t nearest = 0;
  double least = length(difference(line.points[0], to));
  for (std::size_t i = 1; i < line.points.size(); ++i)
    if (const double apart = length(difference(line.points[i], to)); apart < least) {
      least = apart;
      nearest = i;
    }
  return nearest;
}

std::vector<VesselLine> sample_paths(const std::vector<VoxelPath>& paths,
                                     const FlowingVoxels& voxels, const FlowGrid& grid,
                                     const std::vector<float>& wall_um) {
  std::vector<VesselLine> lines;
  std::vector<std::uint32_t> line_of(paths.size(), VesselLine::no_line);
  for (std::size_t p = 0; p < paths.size(); ++p) {
    const std::vector<std::uint32_t>& path = paths[p].voxels;
    VesselLine line;
    if (paths[p].from != VoxelPath::no_path)
      line.from = line_of[paths[p].from];
    const Point fork = voxels.middle_um(path.front());
    const double inside =
        line.from == VesselLine::no_line ? -1.0 : static_cast<double>(wall_um[path.front()]);
    std::vector<Point> points;
    std::vector<double> radii;
    for (const std::uint32_t voxel : path) {
      const Point at = voxels.middle_um(voxel);
      if (points.empty() && length(difference(at, fork)) <= inside)
        continue;
      points.push_back(at);
      radii.push_back(static_cast<double>(wall_um[voxel]));
    }
    trim_end(points, radii);
    if (line.from == VesselLine::no_line)
      trim_begin(points, radii);
    if (points.size() > 1)
      sample(line, softened(points), radii, grid);
    if (line.points.size() < 2) {
      line_of[p] = line.from;
      continue;
    }
    if (line.from != VesselLine::no_line)
      line.fork = nearest_point(lines[line.from], fork);
    line_of[p] = static_cast<std::uint32_t>(lines.size());
    lines.push_back(std::move(line));
  }
  return lines;
}

void extend_ends(std::vector<VesselLine>& lines, const FlowingVoxels& voxels, const FlowGrid& grid,
                 const std::vector<float>& wall_um) {
  for (VesselLine& line : lines) {
    extend_end(line, voxels, grid, wall_um);
    if (line.from != VesselLine::no_line)
      continue;
    const std::size_t before = line.points.size();
    std::ranges::reverse(line.points);
    std::ranges::reverse(line.radii);
    extend_end(line, voxels, grid, wall_um);
    std::ranges::reverse(line.points);
    std::ranges::reverse(line.radii);
    for (VesselLine& other : lines) // forks are counted from the front
      if (line.points.size() > before &&
          other.from == static_cast<std::uint32_t>(&line - lines.data()))
        ++other.fork;
  }
}

} // namespace octascope::pipeline
