#include <cmath>

#include <gtest/gtest.h>

#include "pipeline/vessels/tree_comparison.h"
#include "tests/support/vessels/flow_scene.h"

namespace octascope::pipeline {
namespace {

using tests::add_tube;

VesselTree two_vessels(const Point& shift_um = {}) {
  VesselTree tree;
  const auto at = [&](double x, double y, double z) {
    return Point{x + shift_um[0], y + shift_um[1], z + shift_um[2]};
  };
  add_tube(tree, at(0, 0, 0), at(1000, 0, 0), 20);
  add_tube(tree, at(0, 500, 0), at(3000, 500, 0), 40);
  return tree;
}

TEST(TreeComparison, finds_a_tree_in_itself) {
  const TreeComparison same = compare_trees(two_vessels(), two_vessels(), {});
  EXPECT_NEAR(same.true_length_mm, 4, 1e-4);
  EXPECT_NEAR(same.found_length_mm, 4, 1e-4);
  EXPECT_EQ(same.found_share, 1);
  EXPECT_EQ(same.invented_share, 0);
  EXPECT_NEAR(same.distance.largest_um, 0, 0.01);
  EXPECT_NEAR(same.radius_bias_share, 0, 1e-6);
}

TEST(TreeComparison, tells_errors_by_axis) {
  const TreeComparison moved = compare_trees(two_vessels({0, 30, -12}), two_vessels(), {});
  EXPECT_NEAR(moved.axes[0].p95_um, 0, 0.01);
  EXPECT_NEAR(moved.axes[1].p50_um, 30, 0.01);
  EXPECT_NEAR(moved.axes[2].p95_um, 12, 0.01);
  EXPECT_NEAR(moved.distance.p95_um, std::hypot(30, 12), 0.01);
  EXPECT_EQ(moved.found_share, 1);
}

TEST(TreeComparison, tells_what_is_missed_and_what_is_invented) {
  VesselTree wide;
  add_tube(wide, {0, 500, 0}, {3000, 500, 0}, 40);
  const TreeComparison missed = compare_trees(wide, two_vessels(), {});
  EXPECT_NEAR(missed.found_share, 0.75, 0.005);
  EXPECT_EQ(missed.invented_share, 0);
  const TreeComparison invented = compare_trees(two_vessels(), wide, {});
  EXPECT_EQ(invented.found_share, 1);
  EXPECT_NEAR(invented.invented_share, 0.25, 0.005);
  EXPECT_NEAR(invented.distance.largest_um, 0, 0.01);
}

TEST(TreeComparison, asks_for_no_vessels_that_are_too_thin) {
  VesselTree wide;
  add_tube(wide, {0, 500, 0}, {3000, 500, 0}, 40);
  const ComparisonRules rules{.least_radius_mm = 0.03F};
  EXPECT_EQ(compare_trees(wide, two_vessels(), rules).found_share, 1);
  // Nor does it call them invented.
  const TreeComparison both = compare_trees(two_vessels({0, 10, 0}), two_vessels(), rules);
  EXPECT_EQ(both.invented_share, 0);
  EXPECT_NEAR(both.true_length_mm, 3, 1e-4);
}

TEST(TreeComparison, of_nothing) {
  EXPECT_EQ(compare_trees({}, {}, {}).found_share, 1);
  EXPECT_EQ(compare_trees({}, two_vessels(), {}).found_share, 0);
  EXPECT_EQ(compare_trees(two_vessels(), {}, {}).invented_share, 1);
}

} // namespace
} // namespace octascope::pipeline
