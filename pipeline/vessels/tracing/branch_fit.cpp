#include "pipeline/vessels/tracing/branch_fit.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>

#include "pipeline/vessels/stoppable.h"
#include "pipeline/vessels/vectors.h"

namespace octascope::pipeline {

namespace {

// What belongs to a point of a line.
struct PointFlow {
  double flow = 0;
  Point moment{};     // Σ flow · place from the point
  double across2 = 0; // Σ flow · squared distance from the line
  double length = 0;  // of the line
};

Point way_at(const VesselLine& line, std::size_t i) {
  const std::size_t before = i > 0 ? i - 1 : 0;
  const std::size_t after = std::min(i + 1, line.points.size() - 1);
  return direction(difference(line.points[after], line.points[before]));
}

class LineFit {
public:
  LineFit(std::vector<VesselLine>& lines, const FlowingVoxels& voxels, const FlowGrid& grid,
          const std::stop_token& stop);

  void turn();
  FlowOfLines quality();

private:
  bool assign(); // false: stopped
  void gather();
  void move(VesselLine& line, std::size_t first);

  std::vector<VesselLine>& lines_;
  const FlowingVoxels& voxels_;
  const FlowGrid& grid_;
  const std::stop_token& stop_;
  double full_ = 1; // flow of a voxel that flows as a whole
  std::vector<float> power_;
  std::vector<std::uint32_t> owner_;
  std::vector<std::size_t> first_point_; // of each line, among all points
  std::vector<PointFlow> flows_;         // by point
};

LineFit::LineFit(std::vector<VesselLine>& lines, const FlowingVoxels& voxels, const FlowGrid& grid,
                 const std::stop_token& stop)
    : lines_{lines}, voxels_{voxels}, grid_{grid}, stop_{stop}, power_(voxels.size()),
      owner_(voxels.size()) {
  std::size_t points = 0;
  for (const VesselLine& line : lines) {
    first_point_.push_back(points);
    points += line.points.size();
  }
  flows_.resize(points);
  double flow = 0;
  double squares = 0;
  for (std::uint32_t voxel = 0; voxel < voxels.size(); ++voxel) {
    const double of = voxels.flow_of(grid, voxel);
    flow += of;
    squares += of * of;
  }
  if (flow > 0)
    full_ = squares / flow;
}

bool LineFit::assign() {
  std::ranges::fill(power_, std::numeric_limits<float>::infinity());
  std::ranges::fill(owner_, FlowingVoxels::none);
  StopCheck stopped{stop_};
  for (std::size_t l = 0; l < lines_.size(); ++l)
    for (std::size_t i = 0; i < lines_[l].points.size(); ++i) {
      const double radius = lines_[l].radii[i];
      const auto point = static_cast<std::uint32_t>(first_point_[l] + i);
      voxels_.within(lines_[l].points[i], 1.6 * radius + 0.6 * grid_.widest_um(),
                     [&](std::uint32_t voxel, const Point& apart) {
                       const auto power =
                           static_cast<float>(product(apart, apart) - radius * radius);
                       if (power < power_[voxel]) {
                         power_[voxel] = power;
                         owner_[voxel] = point;
                       }
                     });
      if (stopped())
        return false;
    }
  return true;
}

void LineFit::gather() {
  std::ranges::fill(flows_, PointFlow{});
  std::vector<Point> places(flows_.size());
  std::vector<Point> ways(flows_.size());
  for (std::size_t l = 0; l < lines_.size(); ++l) {
    const VesselLine& line = lines_[l];
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      places[first_point_[l] + i] = line.points[i];
      ways[first_point_[l] + i] = way_at(line, i);
      if (i > 0) {
        const double half = length(difference(line.points[i], line.points[i - 1])) / 2;
        flows_[first_point_[l] + i - 1].length += half;
        flows_[first_point_[l] + i].length += half;
      }
    }
  }
  for (std::uint32_t voxel = 0; voxel < voxels_.size(); ++voxel) {
    const std::uint32_t owner = owner_[voxel];
    if (owner == FlowingVoxels::none)
      continue;
    const Point apart = difference(voxels_.middle_um(voxel), places[owner]);
    const double along = product(apart, ways[owner]);
    const double flow = voxels_.flow_of(grid_, voxel);
    flows_[owner].flow += flow;
    flows_[owner].moment = sum(flows_[owner].moment, scaled(apart, flow));
    flows_[owner].across2 += flow * (product(apart, apart) - along * along);
  }
}

// Solves (1 + strength · D'D) x = y for each coordinate, D the second differences: a symmetric band of
// five, by LDL'.
void smooth_points(std::vector<Point>& points, double strength) {
  const std::size_t n = points.size();
  if (n < 3)
    return;
  std::vector<double> diagonal(n, 1.0);
  std::vector<double> next(n, 0.0);
  std::vector<double> second(n, 0.0);
  for (std::size_t i = 0; i + 2 < n; ++i) {
    diagonal[i] += strength;
    diagonal[i + 1] += 4 * strength;
    diagonal[i + 2] += strength;
    next[i] -= 2 * strength;
    next[i + 1] -= 2 * strength;
    second[i] += strength;
  }
  // L has ones, `next` and `second` below the diagonal.
  for (std::size_t i = 0; i < n; ++i) {
    const double next_whole = next[i];
    const double second_whole = second[i];
    next[i] /= diagonal[i];
    second[i] /= diagonal[i];
    if (i + 1 < n) {
      diagonal[i + 1] -= next_whole * next[i];
      next[i + 1] -= second_whole * next[i];
    }
    if (i + 2 < n)
      diagonal[i + 2] -= second_whole * second[i];
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0)
      points[i] = difference(points[i], scaled(points[i - 1], next[i - 1]));
    if (i > 1)
      points[i] = difference(points[i], scaled(points[i - 2], second[i - 2]));
  }
  for (std::size_t i = 0; i < n; ++i)
    points[i] = scaled(points[i], 1 / diagonal[i]);
  for (std::size_t i = n; i-- > 0;) {
    if (i + 1 < n)
      points[i] = difference(points[i], scaled(points[i + 1], next[i]));
    if (i + 2 < n)
      points[i] = difference(points[i], scaled(points[i + 2], second[i]));
  }
}

// The point's own share and half of each neighbour's.
template <class Of> double with_neighbours(std::size_t i, std::size_t size, const Of& of) {
  return of(i) + (i > 0 ? of(i - 1) / 2 : 0) + (i + 1 < size ? of(i + 1) / 2 : 0);
}

void LineFit::move(VesselLine& line, std::size_t first) {
  const std::size_t size = line.points.size();
  std::vector<Point> moves(size);
  std::vector<double> radii = line.radii;
  for (std::size_t i = 0; i < size; ++i) {
    const auto flow = [&](std::size_t j) { return flows_[first + j].flow; };
    const double whole = with_neighbours(i, size, flow);
    if (whole <= 0)
      continue;
    Point moment{};
    for (std::size_t axis = 0; axis < 3; ++axis)
      moment[axis] = with_neighbours(i, size, [&](std::size_t j) {
        const Point way = way_at(line, j);
        const PointFlow& of = flows_[first + j];
        return of.moment[axis] - product(of.moment, way) * way[axis];
      });
    Point by = scaled(moment, 1 / whole);
    if (const double far = length(by); far > line.radii[i])
      by = scaled(by, line.radii[i] / far);
    moves[i] = by;
    const double along =
        with_neighbours(i, size, [&](std::size_t j) { return flows_[first + j].length; });
    radii[i] = std::sqrt(whole / full_ * grid_.voxel_um3() / (along * std::numbers::pi));
  }
  // At a fork and at a tip flow belongs to a point from beyond its stretch of the line.
  if (radii.size() > 2) {
    radii[0] = radii[1];
    radii[size - 1] = radii[size - 2];
  }
  for (std::size_t i = 0; i < size; ++i)
    line.points[i] = sum(line.points[i], moves[i]);
  line.radii = std::move(radii);
  constexpr double strength = 0.3; // leaves 0.45 of waves of 4 points, 0.77 of 6, 0.96 of 10
  smooth_points(line.points, strength);
}

void LineFit::turn() {
  if (!assign())
    return;
  gather();
  for (std::size_t l = 0; l < lines_.size(); ++l)
    move(lines_[l], first_point_[l]);
}

FlowOfLines LineFit::quality() {
  FlowOfLines found;
  if (!assign())
    return found;
  gather();
  double round = 0;
  // A voxel is spread itself.
  double own = 0;
  for (const double side : grid_.spacing_um)
    own += side * side / 12;
  for (std::size_t l = 0; l < lines_.size(); ++l)
    for (std::size_t i = 0; i < lines_[l].points.size(); ++i) {
      const PointFlow& of = flows_[first_point_[l] + i];
      if (of.flow <= 0)
        continue;
      const double radius = lines_[l].radii[i];
      const double disc = radius * radius / 2 + own;
      round += of.flow * std::min(1.0, disc / std::max(of.across2 / of.flow + own, disc / 100));
      found.explained += of.flow;
    }
  found.roundness = found.explained > 0 ? round / found.explained : 0;
  return found;
}

} // namespace

void fit_lines(std::vector<VesselLine>& lines, const FlowingVoxels& voxels, const FlowGrid& grid,
               const std::stop_token& stop) {
  LineFit fit{lines, voxels, grid, stop};
  for (int turn = 0; turn < 2 && !stop.stop_requested(); ++turn)
    fit.turn();
}

FlowOfLines flow_of_lines(std::vector<VesselLine>& lines, const FlowingVoxels& voxels,
                          const FlowGrid& grid, const std::stop_token& stop) {
  return LineFit{lines, voxels, grid, stop}.quality();
}

} // namespace octascope::pipeline
