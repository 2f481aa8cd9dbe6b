// Trees drawn by lot, written as other programs write centrelines, must come back as they were: the
// length within half a percent, forks and tips exactly, whatever has become of the trunks' copies.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/vessels/centrelines/centreline_joiner.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/vessels/centrelines.h"

namespace octascope::pipeline {
namespace {

using tests::DrawnLines;
using tests::LinePoint;
using tests::Polyline;

struct Shape {
  double length_mm = 0;
  int roots = 0, forks = 0, tips = 0;
};

Shape shape_of(const VesselTree& tree) {
  Shape shape;
  std::vector<int> children(tree.nodes(), 0);
  for (std::size_t i = 0; i < tree.nodes(); ++i) {
    if (tree.parents[i] == no_parent) {
      ++shape.roots;
      continue;
    }
    const auto& a = tree.positions_mm[i];
    const auto& b = tree.positions_mm[tree.parents[i]];
    shape.length_mm += std::hypot(double{a[0]} - double{b[0]}, double{a[1]} - double{b[1]},
                                  double{a[2]} - double{b[2]});
    ++children[tree.parents[i]];
  }
  for (const int count : children) {
    shape.forks += std::max(count - 1, 0);
    shape.tips += count == 0;
  }
  return shape;
}

Shape joined(const std::vector<Polyline>& lines) {
  const JoinedCentrelines joined = join_centrelines(tests::as_centrelines(lines));
  EXPECT_EQ(joined.loop, "");
  EXPECT_EQ(joined.tree.nodes() + joined.merged_points + joined.unused_points,
            tests::as_centrelines(lines).positions_mm.size());
  return shape_of(joined.tree);
}

class CentrelineJoiner : public testing::Test {
protected:
  double number(double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(random);
  }
  std::mt19937_64 random{tests::fresh_seed()};
};

// What a program does to each line on its own.
struct Spoiling {
  const char* what;
  double spacing_mm;    // resampled to, from another place in each line; 0: as drawn
  double drift_mm;      // sideways, growing and falling slowly
  int smoothing;        // Laplacian, as VMTK: so many rounds by a tenth
  double rounded_to_mm; // decimals
  bool single_precision;
  bool backwards; // from the tips to the mouth
};

TEST_F(CentrelineJoiner, takes_copies_of_a_trunk_for_one_vessel) {
  for (const Spoiling& spoiling : {Spoiling{"exact", 0, 0, 0, 0, false, false},
                                   {"single precision", 0, 0, 0, 0, true, false},
                                   {"tenths of a micrometre", 0, 0, 0, 1e-4, false, false},
                                   {"drift of 0.5 um", 0, 5e-4, 0, 0, false, false},
                                   {"drift of 10 um", 0, 0.01, 0, 0, true, false},
                                   {"resampled finely", 0.03, 0, 0, 0, true, false},
                                   {"resampled coarsely", 0.5, 0, 0, 0, false, false},
                                   {"resampled with drift", 0.17, 0.01, 0, 0, true, false},
                                   {"smoothed", 0, 0, 100, 0, false, false},
                                   {"smoothed with drift", 0.12, 0.005, 60, 0, true, false},
                                   {"backwards", 0.2, 0.01, 30, 0, true, true}}) {
    for (int round = 0; round < 25; ++round) {
      DrawnLines drawn = tests::draw_tree(random);
      for (Polyline& line : drawn.lines) {
        if (spoiling.spacing_mm > 0)
          line = tests::resampled(line, spoiling.spacing_mm, number(0.2, 1));
        for (int i = 0; i < spoiling.smoothing; ++i)
          tests::smooth(line);
        tests::drift(line, spoiling.drift_mm, random);
        tests::round_to(line, spoiling.rounded_to_mm);
        if (spoiling.single_precision)
          tests::to_single_precision(line);
        if (spoiling.backwards)
          std::ranges::reverse(line);
      }
      const Shape found = joined(drawn.lines);
      SCOPED_TRACE(testing::Message() << spoiling.what << ", round " << round);
      EXPECT_EQ(found.roots, 1);
      EXPECT_EQ(found.forks, static_cast<int>(drawn.lines.size()) - 1);
      EXPECT_EQ(found.tips, static_cast<int>(drawn.lines.size()));
      EXPECT_NEAR(found.length_mm / drawn.length_mm, 1, 0.005);
    }
  }
}

// Straight, with a point each tenth of a millimetre.
Polyline straight(const tests::LinePosition& from, const tests::LinePosition& to, double radius) {
  const double length = tests::apart(from, to);
  const int steps = static_cast<int>(length / 0.1);
  const tests::LinePosition way = tests::unit({to[0] - from[0], to[1] - from[1], to[2] - from[2]});
  Polyline line;
  for (int i = 0; i <= steps; ++i)
    line.push_back({tests::along(from, way, length * i / steps), radius});
  return line;
}

Polyline operator+(Polyline first, const Polyline& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

// Two vessels as they lie beside, across and upon each other; in a body, at 200 mm, and small, at 0.
TEST_F(CentrelineJoiner, leaves_two_vessels_that_only_touch_two) {
  const Polyline artery = straight({200, 0, 0}, {230, 0, 0}, 1.5);
  const Polyline vein = straight({200, 1.5, 0}, {230, 1.5, 0}, 1.5);
  const Polyline crossing = straight({215, -10, 0}, {215, 10, 0}, 1);
  const Polyline crossing_near = straight({215.03, -10, 1e-5}, {215.03, 10, 1e-5}, 1);
  const Polyline touching =
      straight({205, 8, 0}, {215, 0, 0}, 1) + straight({215, 0, 0}, {225, 8, 0}, 1);
  const Polyline winding = straight({200, 5, 0}, {210, 0, 0}, 1) +
                           straight({210, 0, 0}, {215, 0, 0}, 1) +
                           straight({215, 0, 0}, {225, 5, 0}, 1);
  for (const Polyline& other : {vein, crossing, crossing_near, touching, winding}) {
    for (std::vector<Polyline> lines : {std::vector{artery, other}, std::vector{other, artery}}) {
      double length = 0;
      for (const Polyline& line : lines)
        for (std::size_t i = 1; i < line.size(); ++i)
          length += tests::apart(line[i - 1].at, line[i].at);
      const Shape found = joined(lines);
      EXPECT_EQ(found.roots, 2);
      EXPECT_EQ(found.forks, 0);
      EXPECT_EQ(found.tips, 2);
      EXPECT_NEAR(found.length_mm, length, 1e-3);
    }
  }
}

// From one mouth, apart, and again at one place: no loop, and no vessel is lost.
TEST_F(CentrelineJoiner, never_joins_again_what_has_parted) {
  const Polyline trunk = straight({200, 0, 0}, {210, 0, 0}, 1.5);
  const auto around = [&](double side) {
    return trunk + straight({210, 0, 0}, {215, 5 * side, 0}, 1) +
           straight({215, 5 * side, 0}, {220, 0, 0}, 1);
  };
  const double half = 2 * std::hypot(5, 5);
  for (const auto& [tail, tail_mm] :
       {std::pair{straight({220, 0, 0}, {230, 0, 0}, 1), 10.0}, std::pair{Polyline{}, 0.0}}) {
    const Shape found = joined({around(1) + tail, around(-1) + tail});
    EXPECT_EQ(found.roots, 1);
    EXPECT_EQ(found.forks, 1);
    EXPECT_EQ(found.tips, 2);
    EXPECT_NEAR(found.length_mm, 10 + 2 * (half + tail_mm), 0.05);
  }
}

// One line a vessel: where it begins or ends within a tenth of the radius of another, it is joined.
TEST_F(CentrelineJoiner, joins_ends_by_the_radius) {
  for (const double radius : {1.5, 0.003}) {
    const double mm = radius / 1.5;
    const auto line = [&](tests::LinePosition from, tests::LinePosition to, double r) {
      Polyline made = straight(from, to, r);
      for (LinePoint& point : made) {
        for (double& c : point.at)
          c *= mm;
        point.radius *= mm;
      }
      return made;
    };
    const Polyline trunk = line({0, 0, 0}, {30, 0, 0}, 1.5);
    for (const auto& [gap, roots] : {std::pair{0.0, 1}, {0.05, 1}, {0.2, 2}, {1.5, 2}}) {
      const Polyline branch = line({12.345, gap, 0}, {20, 12, 0}, 1);
      Polyline back = branch;
      std::ranges::reverse(back);
      for (const auto& lines : {std::vector{trunk, branch}, {branch, trunk}, {trunk, back}}) {
        const Shape found = joined(lines);
        EXPECT_EQ(found.roots, roots) << radius << " " << gap;
        EXPECT_EQ(found.forks, 2 - roots);
        EXPECT_NEAR(found.length_mm / mm, 30 + std::hypot(20 - 12.345, 12 - gap), 0.06);
      }
    }
  }
}

// One line a vessel, each begun at a point of the trunk and away from it at once.
TEST_F(CentrelineJoiner, begins_vessels_where_they_were_drawn) {
  const Polyline trunk = straight({200, 0, 0}, {230, 0, 0}, 1.5);
  std::vector<Polyline> lines{trunk};
  std::size_t points = trunk.size();
  for (std::size_t i = 1; i <= 10; ++i) {
    const tests::LinePosition& from = trunk[i * 25].at;
    const double angle = number(0.4, 2.7);
    const double around = 2 * static_cast<double>(i); // none near another
    lines.push_back(straight(from,
                             tests::along(from,
                                          {std::cos(angle), std::sin(angle) * std::cos(around),
                                           std::sin(angle) * std::sin(around)},
                                          8),
                             1));
    points += lines.back().size() - 1;
  }
  std::ranges::shuffle(lines, random);
  const JoinedCentrelines joined = join_centrelines(tests::as_centrelines(lines));
  EXPECT_NEAR(static_cast<double>(joined.tree.nodes()), static_cast<double>(points), 3);
  const Shape found = shape_of(joined.tree);
  EXPECT_EQ(found.roots, 1);
  EXPECT_EQ(found.forks, 10);
  EXPECT_NEAR(found.length_mm, 30 + 10 * 8, 0.1);
}

// Two mouths and two tips, each joined with each by a line: what flows together parts again.
TEST_F(CentrelineJoiner, joins_lines_from_two_mouths) {
  const Polyline middle = straight({210, 0, 0}, {225, 0, 0}, 1.5);
  std::vector<Polyline> lines;
  for (const double from : {8.0, -8.0})
    for (const double to : {9.0, -9.0}) {
      lines.push_back(straight({200, from, 0}, {210, 0, 0}, 1) + middle +
                      straight({225, 0, 0}, {235, to, 0}, 1));
      tests::drift(lines.back(), 0.01, random);
    }
  const Shape found = joined(lines);
  EXPECT_EQ(found.roots, 1);
  EXPECT_EQ(found.forks, 2);
  EXPECT_EQ(found.tips, 3);
  EXPECT_NEAR(found.length_mm, 15 + 2 * (std::hypot(8, 10) + std::hypot(9, 10)), 0.3);
}

// As a clean-up that makes equal points one leaves them: the copies share some of the trunk's.
TEST_F(CentrelineJoiner, takes_points_that_copies_share) {
  Polyline a = straight({200, 0, 0}, {220, 0, 0}, 1.5) + straight({220, 0, 0}, {230, 9, 0}, 1);
  Polyline b = straight({200, 0, 0}, {220, 0, 0}, 1.5) + straight({220, 0, 0}, {230, -9, 0}, 1);
  Centrelines lines = tests::as_centrelines({a, b});
  for (std::size_t i = 0; i < 200; ++i)
    if (i < 50 || i > 150)
      lines.points[a.size() + i] = i;
  const JoinedCentrelines joined = join_centrelines(lines);
  EXPECT_EQ(joined.loop, "");
  const Shape found = shape_of(joined.tree);
  EXPECT_EQ(found.forks, 1);
  EXPECT_EQ(found.tips, 2);
  EXPECT_NEAR(found.length_mm, 20 + 2 * std::hypot(10, 9), 0.1);
}

} // namespace
} // namespace octascope::pipeline
