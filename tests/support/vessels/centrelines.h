// Centrelines as other programs write them, for tests of what joins them: trees drawn by lot, a line
// from the mouth to every tip, and what rounding, resampling and smoothing do to each line.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <vector>

#include "pipeline/vessels/centrelines/centreline_joiner.h"

namespace octascope::tests {

using LinePosition = std::array<double, 3>;

struct LinePoint {
  LinePosition at{};
  double radius = 0;
};
using Polyline = std::vector<LinePoint>;

inline LinePosition along(const LinePosition& from, const LinePosition& way, double by) {
  return {from[0] + by * way[0], from[1] + by * way[1], from[2] + by * way[2]};
}

inline double apart(const LinePosition& a, const LinePosition& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

inline LinePosition unit(const LinePosition& way) {
  const double length = std::hypot(way[0], way[1], way[2]);
  return {way[0] / length, way[1] / length, way[2] / length};
}

inline LinePosition across(const LinePosition& a, const LinePosition& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

struct DrawnLines {
  std::vector<Polyline> lines;
  double length_mm = 0; // of the vessels, each once
};

// A trunk of some 1.5 mm of radius that forks a few times, around (220, 170, 22) mm; vessels bend
// slowly, daughters leave at 35 to 60 degrees to either side with four fifths of the radius.
class TreeDrawer {
public:
  explicit TreeDrawer(std::mt19937_64& random) : random_{random} {}

  DrawnLines draw() {
    grow({{{220, 170, 22}, number(1.2, 1.8)}}, unit({number(-1, 1), -2, number(-1, 1)}), 3);
    return std::move(drawn_);
  }

private:
  double number(double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random_);
  }

  void grow(Polyline line, LinePosition way, int forks) {
    const double radius = line.back().radius;
    const double length = radius * number(12, 18);
    const double spacing = number(0.08, 0.12);
    LinePosition axis = unit(across(way, {number(-1, 1), number(-1, 1), number(-1, 1)}));
    const double bend = number(0, 0.04) / radius; // radians a mm
    const int steps = static_cast<int>(length / spacing);
    for (int i = 0; i < steps; ++i) {
      way = unit(along(way, across(axis, way), bend * spacing));
      line.push_back({along(line.back().at, way, spacing), radius});
      drawn_.length_mm += spacing;
    }
    if (forks == 0 || (forks < 3 && number(0, 1) < 0.3)) {
      drawn_.lines.push_back(std::move(line));
      return;
    }
    const LinePosition side = unit(across(way, {number(-1, 1), number(-1, 1), number(-1, 1)}));
    for (const double sign : {1.0, -1.0}) {
      const double angle = sign * number(35, 60) * std::numbers::pi / 180;
      LinePosition turned{};
      for (std::size_t i = 0; i < 3; ++i)
        turned[i] = std::cos(angle) * way[i] + std::sin(angle) * side[i];
      Polyline daughter = line;
      daughter.back().radius = 0.8 * radius;
      grow(std::move(daughter), turned, forks - 1);
    }
  }

  std::mt19937_64& random_;
  DrawnLines drawn_;
};

inline DrawnLines draw_tree(std::mt19937_64& random) {
  return TreeDrawer{random}.draw();
}

// Points each `spacing` along the line, the first after a part of it; both ends stay.
inline Polyline resampled(const Polyline& line, double spacing, double first_part) {
  Polyline made{line.front()};
  double next = first_part * spacing;
  double travelled = 0;
  for (std::size_t i = 1; i < line.size(); ++i) {
    const double step = apart(line[i - 1].at, line[i].at);
    for (; next < travelled + step; next += spacing) {
      const double share = (next - travelled) / step;
      LinePoint point{{}, std::lerp(line[i - 1].radius, line[i].radius, share)};
      for (std::size_t axis = 0; axis < 3; ++axis)
        point.at[axis] = std::lerp(line[i - 1].at[axis], line[i].at[axis], share);
      made.push_back(point);
    }
    travelled += step;
  }
  made.push_back(line.back());
  return made;
}

// One round of VMTK's: each point but the ends a tenth of the way to the middle of its neighbours.
inline void smooth(Polyline& line) {
  LinePosition before = line.front().at;
  for (std::size_t i = 1; i + 1 < line.size(); ++i) {
    const LinePosition here = line[i].at;
    for (std::size_t axis = 0; axis < 3; ++axis)
      line[i].at[axis] = 0.9 * here[axis] + 0.05 * (before[axis] + line[i + 1].at[axis]);
    before = here;
  }
}

// Sideways by up to so much: some waves along the line, the longest as long as itself.
inline void drift(Polyline& line, double by_mm, std::mt19937_64& random) {
  std::uniform_real_distribution<double> turn{0, 2 * std::numbers::pi};
  const std::array<double, 3> phase{turn(random), turn(random), turn(random)};
  const auto last = static_cast<double>(line.size() - 1);
  for (std::size_t i = 0; i < line.size(); ++i) {
    const double at = static_cast<double>(i) / last;
    for (std::size_t axis = 0; axis < 3; ++axis)
      line[i].at[axis] += by_mm / 3 *
                          (std::sin(2 * at + phase[axis]) + std::sin(20 * at + 2 * phase[axis]) +
                           0.2 * std::sin(300 * at + 3 * phase[axis]));
  }
}

inline void round_to(Polyline& line, double step_mm) {
  if (step_mm > 0)
    for (LinePoint& point : line)
      for (double& c : point.at)
        c = step_mm * std::round(c / step_mm);
}

inline void to_single_precision(Polyline& line) {
  for (LinePoint& point : line)
    for (double& c : point.at)
      c = static_cast<double>(static_cast<float>(c));
}

// Each line with points of its own.
inline pipeline::Centrelines as_centrelines(const std::vector<Polyline>& lines) {
  pipeline::Centrelines made;
  for (const Polyline& line : lines) {
    for (const LinePoint& point : line) {
      made.points.push_back(made.positions_mm.size());
      made.positions_mm.push_back(point.at);
      made.radii_mm.push_back(point.radius);
    }
    made.ends.push_back(made.points.size());
  }
  return made;
}

} // namespace octascope::tests
