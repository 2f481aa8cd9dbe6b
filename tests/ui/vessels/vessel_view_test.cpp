// Where cameras that look at vessel trees stand, and the arithmetic that shaders share.
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <gtest/gtest.h>

#include "pipeline/vessels/clusters/cluster_builder.h"
#include "tests/support/vessels/random_tree.h"
#include "ui/vessels/scene/segment_projection.h"
#include "ui/vessels/view/dense_place.h"
#include "ui/vessels/view/vessel_view.h"

namespace octascope::tests {
namespace {

TEST(VesselView, the_whole_tree_fills_the_picture) {
  const auto tree = random_tree(3000, 1);
  const auto arrays = pipeline::build_clusters(tree);
  for (const auto& [width, height] : {std::pair{1280, 720}, {400, 900}}) {
    const auto view =
        ui::make_benchmark_view(ui::BenchmarkView::whole, arrays.view(), width, height);
    const auto camera =
        ui::make_vessel_camera(view, ui::vessel_bounds(arrays.view()), width, height);
    const float aspect = static_cast<float>(width) / static_cast<float>(height);
    glm::vec2 lowest{1}; // of what a picture's half is 1
    glm::vec2 highest{-1};
    for (std::size_t i = 0; i < tree.nodes(); ++i) {
      const auto& p = tree.positions_mm[i];
      const glm::vec3 place{p[0], p[1], p[2]};
      const float reach = tree.radii_mm[i] / (camera.depth_of(place) * camera.tan_half_height);
      const glm::vec2 at = 2.0F * camera.project(place);
      lowest = glm::min(lowest, (at - reach) / glm::vec2{aspect, 1});
      highest = glm::max(highest, (at + reach) / glm::vec2{aspect, 1});
      EXPECT_GE(camera.depth_of(place), camera.near_mm);
      EXPECT_LE(camera.depth_of(place), camera.far_mm);
    }
    const glm::vec2 filled = 0.5F * (highest - lowest);
    EXPECT_LE(std::max(filled.x, filled.y), 0.97F);
    EXPECT_GE(std::max(filled.x, filled.y), 0.94F);
    EXPECT_NEAR(highest.x, -lowest.x, 0.01F) << "in the middle";
    EXPECT_NEAR(highest.y, -lowest.y, 0.01F);
  }
}

TEST(VesselView, has_its_scale_at_its_target) {
  ui::VesselView view;
  view.target_mm = {3, -2, 8};
  view.mm_per_pixel = 0.02F;
  const ui::VesselBounds bounds{{-50, -50, -50}, {50, 50, 50}};
  const auto camera = ui::make_vessel_camera(view, bounds, 1280, 720);
  const glm::vec2 middle = camera.project(view.target_mm);
  EXPECT_NEAR(middle.x, 0, 1e-5F);
  EXPECT_NEAR(middle.y, 0, 1e-5F);
  const glm::vec2 up = camera.project(view.target_mm + 100 * view.mm_per_pixel * camera.up);
  EXPECT_NEAR(up.y * 720, -100, 0.01F);
  const auto look = ui::with_cue({}, view, bounds, 1280, 720);
  EXPECT_GE(look.cue_near_mm, camera.near_mm);
  EXPECT_LE(look.cue_far_mm, camera.far_mm);
  EXPECT_LT(look.cue_near_mm, camera.depth_of(view.target_mm));
  EXPECT_GT(look.cue_far_mm, camera.depth_of(view.target_mm));
}

TEST(VesselView, turned_moves_what_is_near_and_what_is_far_alike) {
  ui::VesselView view;
  view.target_mm = {3, -2, 8};
  const ui::VesselBounds bounds{{-50, -50, -50}, {50, 50, 50}};
  const auto camera = ui::make_vessel_camera(view, bounds, 1280, 720);
  const auto turned = ui::turned(camera, 0.375F, -0.125F, 720);
  for (const float depth_mm : {-20.0F, 0.0F, 40.0F}) {
    const glm::vec3 place = view.target_mm + depth_mm * camera.forward;
    const glm::vec2 moved_px = 720.0F * (turned.project(place) - camera.project(place));
    EXPECT_NEAR(moved_px.x, -0.375F, 1e-3F) << depth_mm;
    EXPECT_NEAR(moved_px.y, -0.125F, 1e-3F) << depth_mm;
    const glm::vec4 clip = turned.view_projection * glm::vec4{place, 1};
    EXPECT_NEAR(0.5F * 1280 * clip.x / clip.w, -0.375F, 2e-3F) << depth_mm;
  }
}

TEST(DensePlace, is_where_most_segments_are) {
  pipeline::ClusterArrays arrays;
  const auto add = [&](std::array<float, 3> at, std::uint8_t segments) {
    pipeline::VesselCluster cluster{};
    cluster.origin_mm = at;
    cluster.nodes = segments;
    arrays.clusters.push_back(cluster);
  };
  for (int i = 0; i < 40; ++i)
    add({static_cast<float>(i), 0, 0}, 10);
  for (int i = 0; i < 4; ++i)
    add({20, 7 + 0.1F * static_cast<float>(i), 0}, 100);
  const glm::vec3 place = ui::densest_place(arrays.view(), glm::mat3{1}, glm::vec3{2});
  EXPECT_NEAR(place.x, 20, 1e-4F);
  EXPECT_NEAR(place.y, 7.15F, 1e-4F);
  EXPECT_EQ(ui::densest_place({}, glm::mat3{1}, glm::vec3{2}), glm::vec3{0});
}

TEST(SegmentProjection, powers_of_two_are_right_to_single_precision) {
  for (float x = -1; x < 14; x += 0.0137F)
    EXPECT_NEAR(static_cast<double>(ui::power_of_two(x)) / std::exp2(static_cast<double>(x)), 1,
                3e-6);
}

} // namespace
} // namespace octascope::tests
