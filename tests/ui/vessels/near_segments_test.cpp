// The segments near a plane or a volume are found, with bounded work.
#include <algorithm>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/vessels/clusters/cluster_builder.h"
#include "tests/support/vessels/random_tree.h"
#include "tests/support/vessels/vessel_trees.h"
#include "ui/vessels/sections/near_segments.h"

namespace octascope::tests {
namespace {

using ui::NearSegments;

// How many segments' boxes, `larger_mm` larger each way, meet it.
std::size_t count_near(const pipeline::VesselTree& tree, const ui::VolumeBox& box,
                       float larger_mm) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < tree.nodes(); ++i) {
    if (tree.parents[i] == pipeline::no_parent)
      continue;
    const float end_radius = tree.radii_mm[i];
    const float start_radius =
        pipeline::segment_start_radius(tree.radii_mm[tree.parents[i]], end_radius);
    bool meets = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const float from = tree.positions_mm[tree.parents[i]][axis];
      const float to = tree.positions_mm[i][axis];
      const auto side = static_cast<glm::length_t>(axis);
      meets = meets &&
              std::min(from - start_radius, to - end_radius) - larger_mm <= box.upper_mm[side] &&
              std::max(from + start_radius, to + end_radius) + larger_mm >= box.lower_mm[side];
    }
    count += meets ? 1 : 0;
  }
  return count;
}

TEST(NearSegmentsTest, are_all_those_that_meet_the_box) {
  const pipeline::VesselTree tree = random_tree(4000, 3);
  const auto arrays = pipeline::build_clusters(tree);
  NearSegments near;
  near.reserve(arrays.clusters.size());
  for (const float at_mm : {-2.0F, -0.5F, 0.0F, 1.0F}) {
    const ui::VolumeBox box{{-6, at_mm - 2, -6}, {6, at_mm + 2, 6}};
    near.find(arrays.view(), {}, box);
    ASSERT_TRUE(near.complete());
    EXPECT_GE(near.segments().size(), count_near(tree, box, -0.01F));
    EXPECT_LE(near.segments().size(), count_near(tree, box, 0.01F));
    EXPECT_GT(near.segments().size(), 5U);
    EXPECT_LT(near.examined(), 4000U) << "clusters far away are not looked into";
  }
}

// Turned and shifted with the tree, the box finds the same.
TEST(NearSegmentsTest, are_placed_by_the_registration) {
  const pipeline::VesselTree tree = random_tree(3000, 4);
  const auto arrays = pipeline::build_clusters(tree);
  pipeline::RigidTransform turned; // x to y, y to −x
  turned.rotation = {{{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}};
  turned.shift_mm = {7, -2, 4};
  NearSegments here;
  NearSegments there;
  here.reserve(arrays.clusters.size());
  there.reserve(arrays.clusters.size());
  here.find(arrays.view(), {}, {{-1, 0.5F, -2}, {3, 1.5F, 2}});
  there.find(arrays.view(), turned,
             {{7 - 1.5F, -2 - 1.0F, 4 - 2.0F}, {7 - 0.5F, -2 + 3.0F, 4 + 2.0F}});
  ASSERT_GT(here.segments().size(), 10U);
  ASSERT_EQ(here.segments().size(), there.segments().size());
  for (std::size_t i = 0; i < here.segments().size(); ++i) {
    const glm::vec3 from = here.segments()[i].from_mm;
    EXPECT_NEAR(there.segments()[i].from_mm.x, 7 - from.y, 1e-4F);
    EXPECT_NEAR(there.segments()[i].from_mm.y, -2 + from.x, 1e-4F);
    EXPECT_NEAR(there.segments()[i].from_mm.z, 4 + from.z, 1e-4F);
  }
}

TEST(NearSegmentsTest, too_many_leave_the_thickest) {
  const pipeline::VesselTree tree = random_tree(30000, 5);
  const auto arrays = pipeline::build_clusters(tree);
  NearSegments near;
  near.reserve(arrays.clusters.size());
  near.find(arrays.view(), {}, {glm::vec3{-1e3F}, glm::vec3{1e3F}});
  EXPECT_FALSE(near.complete());
  EXPECT_EQ(near.examined(), 30000U);
  ASSERT_EQ(near.segments().size(), NearSegments::most_segments);
  std::vector<float> all;
  for (std::size_t i = 0; i < tree.nodes(); ++i)
    if (tree.parents[i] != pipeline::no_parent)
      all.push_back(
          std::max(tree.radii_mm[i], pipeline::segment_start_radius(tree.radii_mm[tree.parents[i]],
                                                                    tree.radii_mm[i])));
  std::ranges::sort(all, std::ranges::greater{});
  std::vector<float> kept;
  for (const ui::NearSegment& s : near.segments())
    kept.push_back(s.thickest_mm());
  std::ranges::sort(kept, std::ranges::greater{});
  for (std::size_t i = 0; i < kept.size(); i += 64)
    EXPECT_NEAR(kept[i], all[i], 0.01F * all[i]);
}

TEST(NearSegmentsTest, looks_at_no_more_than_it_may_and_at_the_thickest_first) {
  constexpr std::size_t thin = 2 * NearSegments::most_examined;
  pipeline::VesselTree tree = chain_tree(thin, 6);
  // A thick vessel at the end of the arrays.
  const auto root = static_cast<std::uint32_t>(tree.nodes());
  for (std::uint32_t i = 0; i < 1000; ++i) {
    tree.positions_mm.push_back({0.05F * static_cast<float>(i), 0, 0});
    tree.radii_mm.push_back(0.5F);
    tree.parents.push_back(i == 0 ? pipeline::no_parent : root + i - 1);
    tree.orders.push_back(9);
    tree.branches.push_back(pipeline::VesselBranch::rca);
  }
  const auto arrays = pipeline::build_clusters(tree);
  NearSegments near;
  near.reserve(arrays.clusters.size());
  near.find(arrays.view(), {}, {glm::vec3{-1e3F}, glm::vec3{1e3F}});
  EXPECT_FALSE(near.complete());
  EXPECT_LE(near.examined(), NearSegments::most_examined);
  EXPECT_GT(near.examined(), NearSegments::most_examined / 2);
  EXPECT_EQ(near.segments().size(), NearSegments::most_segments);
  EXPECT_EQ(
      std::ranges::count(near.segments(), pipeline::VesselBranch::rca, &ui::NearSegment::branch),
      999);
}

} // namespace
} // namespace octascope::tests
