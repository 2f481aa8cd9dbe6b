// The processor's vessels against the definition of their shape, whatever draws them.
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "pipeline/vessels/clusters/cluster_builder.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/fails_with.h"
#include "tests/support/vessels/random_tree.h"
#include "tests/ui/support/reference_vessels.h"
#include "ui/vessels/splatter/merged_order.h"
#include "ui/vessels/splatter/splatter.h"

namespace octascope::tests {
namespace {

constexpr int width = 320;
constexpr int height = 180;

ui::Splatter make_splatter(std::size_t helpers, std::string_view isa = {}) {
  auto splatter = ui::Splatter::create(helpers, {}, isa);
  EXPECT_TRUE(splatter) << splatter.error().message;
  return std::move(*splatter);
}

ui::Camera camera_at(float yaw_deg, float distance, ui::StereoEye eye = ui::StereoEye::centre) {
  ui::ViewState view;
  view.yaw_deg = yaw_deg;
  view.tilt_deg = 25;
  view.distance = distance;
  view.parallax_deg = 4;
  return ui::make_camera(view, {20, 20, 20}, static_cast<float>(width) / height, eye);
}

ui::VesselScene scene_of(const pipeline::VesselClusters& tree, const ui::Camera& camera) {
  ui::VesselScene scene{.tree = tree, .camera = camera, .look = {}};
  scene.width = width;
  scene.height = height;
  scene.look.cue_near_mm = camera.near_mm;
  scene.look.cue_far_mm = camera.far_mm;
  return scene;
}

// A random tree, seen from there.
struct SeenTree {
  SeenTree(std::size_t nodes, std::uint64_t seed, float yaw_deg, float distance)
      : arrays{pipeline::build_clusters(random_tree(nodes, seed))}, camera{camera_at(yaw_deg,
                                                                                     distance)} {}
  pipeline::ClusterArrays arrays;
  pipeline::VesselClusters tree = arrays.view();
  ui::Camera camera;
  ui::VesselScene scene = scene_of(tree, camera);
};

// What wide vessels show turns fast near their outlines: there a few differ. Where two are as good
// as equally near, rounding decides whose colour is seen.
void expect_right(const ui::VesselScene& scene, const ui::DepthImage& image) {
  int covered = 0;
  int in_coverage = 0;
  int in_distance = 0;
  int in_colour = 0;
  for (std::size_t i = 0; const ReferenceVesselPixel& right : reference_vessels(scene)) {
    const int x = static_cast<int>(i) % width;
    const int y = static_cast<int>(i++) / width;
    if (right.to_outline_px < 0.01)
      continue;
    const bool shown = image.at(x, y) != ui::empty_depth_pixel;
    in_coverage += shown != right.covered();
    if (!shown || !right.covered())
      continue;
    ++covered;
    in_distance += std::abs(double{image.distance_mm(x, y)} / right.depth_mm - 1) > 2e-4;
    bool coloured = image.rgba(x, y) >> 24U == 255;
    for (std::size_t channel = 0; channel < 3; ++channel) {
      const double level = image.rgba(x, y) >> (8 * channel) & 255U;
      coloured &= std::abs(level - 255 * double{right.colour[channel]} * right.brightness) <= 2;
    }
    in_colour += !coloured && right.next_mm > right.depth_mm * (1 + 2e-4);
  }
  EXPECT_GT(covered, 100);
  EXPECT_EQ(in_coverage, 0) << "of " << covered;
  EXPECT_LE(in_distance, covered / 1000) << "of " << covered;
  EXPECT_LE(in_colour, covered / 1000) << "of " << covered;
}

TEST(VesselSplatter, every_pixel_shows_what_the_shape_says) {
  const auto arrays = pipeline::build_clusters(tests::random_tree(4000, 11));
  const auto tree = arrays.view();
  ui::Splatter splatter = make_splatter(1);
  ui::DepthImage image;
  float yaw = 0;
  for (const float distance : {12.0F, 3.0F, 1.2F, 0.4F}) { // the last one from amidst them
    const ui::Camera camera = camera_at(yaw += 70, distance, ui::StereoEye::left);
    ui::VesselScene scene = scene_of(tree, camera);
    scene.world_from_tree = glm::rotate(glm::mat4{1}, yaw, glm::vec3{0.6F, 0.8F, 0});
    scene.world_from_tree[3] = {1, -2, 0.5F, 1};
    scene.look.colouring = distance < 2 ? ui::VesselColouring::order : ui::VesselColouring::branch;
    const auto account = splatter.draw(scene, image);
    ASSERT_TRUE(account) << account.error().message;
    EXPECT_EQ(account->total(), tree.segments);
    SCOPED_TRACE(distance);
    expect_right(scene, image);
  }
}

TEST(VesselSplatter, every_instruction_set_draws_the_same_shapes) {
  SeenTree seen{3000, 12, 20, 2.5F};
  int found = 0;
  for (const char* isa : {"AVX3", "AVX2", "SSE4", "NEON", "EMU128"}) {
    auto splatter = ui::Splatter::create(0, {}, isa);
    if (!splatter)
      continue;
    ++found;
    ui::DepthImage image;
    ASSERT_TRUE(splatter->draw(seen.scene, image));
    SCOPED_TRACE(isa);
    expect_right(seen.scene, image);
  }
  EXPECT_GT(found, 0);
}

TEST(VesselSplatter, says_which_instruction_set_it_has_not) {
  EXPECT_THAT(ui::Splatter::create(0, {}, "Z80"), FailsSaying("'Z80'"));
}

TEST(VesselSplatter, threads_make_no_difference_to_the_bit) {
  SeenTree seen{60000, 13, 120, 2};
  ui::Splatter alone = make_splatter(0);
  ui::Splatter team = make_splatter(3);
  ui::DepthImage expected;
  ASSERT_TRUE(alone.draw(seen.scene, expected));
  for (int i = 0; i < 5; ++i) {
    ui::DepthImage image;
    ASSERT_TRUE(team.draw(seen.scene, image));
    EXPECT_TRUE(image.pixels == expected.pixels);
  }
}

TEST(VesselSplatter, allocates_nothing_after_the_first_frame) {
  SeenTree seen{2000, 14, 120, 2};
  ui::Splatter splatter = make_splatter(1);
  ui::DepthImage image;
  ASSERT_TRUE(splatter.draw(seen.scene, image));
  const auto before = allocations_of_this_thread();
  ASSERT_TRUE(splatter.draw(seen.scene, image));
  EXPECT_EQ(allocations_of_this_thread(), before);
}

TEST(VesselSplatter, refuses_pictures_without_pixels_and_shares_of_other_trees) {
  SeenTree seen{300, 15, 0, 2};
  ui::Splatter splatter = make_splatter(0);
  ui::DepthImage image;
  const std::vector<std::uint8_t> shares(seen.tree.clusters.size() + 1);
  EXPECT_FALSE(splatter.draw(seen.scene, image, {shares, 0}));
  seen.scene.height = 0;
  EXPECT_FALSE(splatter.draw(seen.scene, image));
}

TEST(VesselSplatter, what_others_take_is_neither_drawn_nor_counted) {
  SeenTree seen{5000, 16, 40, 1.2F};
  ui::Splatter splatter = make_splatter(1);
  ui::DepthImage image;
  std::vector<std::uint8_t> taken;
  std::uint64_t left = 0;
  for (const auto& cluster : seen.tree.clusters) {
    taken.push_back(cluster.nodes_from_order[4]);
    left += static_cast<std::uint64_t>(cluster.nodes - cluster.nodes_from_order[4]);
  }
  ASSERT_LT(left, seen.tree.segments);
  const auto account = splatter.draw(seen.scene, image, {taken, 0.3F});
  ASSERT_TRUE(account);
  EXPECT_EQ(account->total(), left);
  for (std::size_t i = 0; i < taken.size(); ++i)
    taken[i] = seen.tree.clusters[i].nodes;
  const auto nothing = splatter.draw(seen.scene, image, {taken, 0});
  ASSERT_TRUE(nothing);
  EXPECT_EQ(nothing->total(), 0U);
  EXPECT_TRUE(std::ranges::all_of(image.pixels, [](auto p) { return p == ui::empty_depth_pixel; }));
}

TEST(VesselSplatter, merging_is_exact_in_width_and_without_steps) {
  float before = 1;
  for (float detail = 0; detail < 0.5F; detail += 0.001F) {
    const ui::MergedOrder order = ui::merged_order(0.04F, detail, 37);
    const float wide = static_cast<float>(order.whole) * order.widening;
    EXPECT_NEAR(wide + order.last_widening, 37, 1e-3) << detail;
    EXPECT_LE(order.whole + (order.last_widening > 0 ? 1U : 0U), 37U);
    EXPECT_LE(order.widening - before, 0.03F) << detail;
    EXPECT_GE(order.widening, before);
    before = order.widening;
  }
}

} // namespace
} // namespace octascope::tests
