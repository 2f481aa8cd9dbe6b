// The processor's vessels against the definition of their shape, whatever draws them.
#include <numbers>
#include <random>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "pipeline/vessels/clusters/cluster_builder.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/vessels/random_tree.h"
#include "tests/ui/support/vessels/splat_check.h"
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

void expect_right(const ui::VesselScene& scene, const ui::DepthImage& image) {
  const SplatCheck check = check_splats(scene, image);
  EXPECT_GT(check.covered, 100U);
  EXPECT_EQ(check.unexplained, 0U) << "of " << check.covered;
  EXPECT_EQ(check.missed, 0U) << "of " << check.covered;
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
    expect_right(scene, splatter.sharp());
    EXPECT_GT(check_splats(scene, splatter.sharp()).sub_pixel, distance > 10 ? 1000U : 0U);
  }
}

TEST(VesselSplatter, every_instruction_set_draws_the_same_shapes) {
  const auto arrays = pipeline::build_clusters(tests::random_tree(3000, 12));
  const auto tree = arrays.view();
  const ui::Camera camera = camera_at(20, 2.5F);
  const ui::VesselScene scene = scene_of(tree, camera);
  int found = 0;
  for (const char* isa : {"AVX3", "AVX2", "SSE4", "NEON", "EMU128"}) {
    auto splatter = ui::Splatter::create(0, {}, isa);
    if (!splatter)
      continue;
    ++found;
    ui::DepthImage image;
    ASSERT_TRUE(splatter->draw(scene, image));
    SCOPED_TRACE(isa);
    expect_right(scene, splatter->sharp());
  }
  EXPECT_GT(found, 0);
}

TEST(VesselSplatter, says_which_instruction_set_it_has_not) {
  const auto splatter = ui::Splatter::create(0, {}, "Z80");
  ASSERT_FALSE(splatter);
  EXPECT_NE(splatter.error().message.find("'Z80'"), std::string::npos) << splatter.error().message;
}

TEST(VesselSplatter, threads_make_no_difference_to_the_bit) {
  const auto arrays = pipeline::build_clusters(tests::random_tree(60000, 13));
  const auto tree = arrays.view();
  const ui::Camera camera = camera_at(120, 2);
  const ui::VesselScene scene = scene_of(tree, camera);
  ui::Splatter alone = make_splatter(0);
  ui::Splatter team = make_splatter(3);
  ui::DepthImage expected;
  ASSERT_TRUE(alone.draw(scene, expected));
  for (int i = 0; i < 5; ++i) {
    ui::DepthImage image;
    ASSERT_TRUE(team.draw(scene, image));
    EXPECT_TRUE(image.pixels == expected.pixels);
    EXPECT_TRUE(team.sharp().pixels == alone.sharp().pixels);
  }
}

TEST(VesselSplatter, allocates_nothing_after_the_first_frame) {
  const auto arrays = pipeline::build_clusters(tests::random_tree(2000, 14));
  const auto tree = arrays.view();
  const ui::Camera camera = camera_at(120, 2);
  const ui::VesselScene scene = scene_of(tree, camera);
  ui::Splatter splatter = make_splatter(1);
  ui::DepthImage image;
  ASSERT_TRUE(splatter.draw(scene, image));
  const auto before = allocations_of_this_thread();
  ASSERT_TRUE(splatter.draw(scene, image));
  EXPECT_EQ(allocations_of_this_thread(), before);
}

TEST(VesselSplatter, refuses_pictures_without_pixels_and_shares_of_other_trees) {
  const auto arrays = pipeline::build_clusters(tests::random_tree(300, 15));
  const auto tree = arrays.view();
  const ui::Camera camera = camera_at(0, 2);
  ui::VesselScene scene = scene_of(tree, camera);
  ui::Splatter splatter = make_splatter(0);
  ui::DepthImage image;
  const std::vector<std::uint8_t> shares(tree.clusters.size() + 1);
  EXPECT_FALSE(splatter.draw(scene, image, {shares, 0}));
  scene.height = 0;
  EXPECT_FALSE(splatter.draw(scene, image));
}

TEST(VesselSplatter, says_in_which_columns_vessels_are) {
  const auto arrays = pipeline::build_clusters(tests::random_tree(4000, 16));
  const auto tree = arrays.view();
  ui::Splatter splatter = make_splatter(1);
  ui::DepthImage image;
  const ui::Camera camera = camera_at(10, 8);
  int narrower = 0;
  for (const float shift : {-0.8F, 0.0F, 0.8F, 5.0F}) { // of the picture's height
    ui::VesselScene scene = scene_of(tree, camera);
    scene.width = 4 * width;
    scene.world_from_tree[3] = glm::vec4{
        shift * 4 * camera.tan_half_height * camera.depth_of({0, 0, 0}) * camera.right, 1};
    ASSERT_TRUE(splatter.draw(scene, image));
    const ui::SplatColumns columns = splatter.columns();
    int covered = 0;
    for (int y = 0; y < scene.height; ++y)
      for (int x = 0; x < scene.width; ++x)
        if (image.at(x, y) != ui::empty_depth_pixel) {
          ++covered;
          ASSERT_GE(x, columns.first);
          ASSERT_LT(x, columns.end);
        }
    EXPECT_EQ(covered > 0, shift < 5) << shift;
    EXPECT_EQ(columns.end > columns.first, covered > 0) << shift;
    narrower += columns.end - columns.first < scene.width;
  }
  EXPECT_GE(narrower, 3);
}

TEST(VesselSplatter, what_others_take_is_neither_drawn_nor_counted) {
  const auto arrays = pipeline::build_clusters(tests::random_tree(5000, 16));
  const auto tree = arrays.view();
  const ui::Camera camera = camera_at(40, 1.2F);
  const ui::VesselScene scene = scene_of(tree, camera);
  ui::Splatter splatter = make_splatter(1);
  ui::DepthImage image;
  std::vector<std::uint8_t> taken;
  std::uint64_t left = 0;
  for (const auto& cluster : tree.clusters) {
    taken.push_back(cluster.nodes_from_order[4]);
    left += static_cast<std::uint64_t>(cluster.nodes - cluster.nodes_from_order[4]);
  }
  ASSERT_LT(left, tree.segments);
  const auto account = splatter.draw(scene, image, {taken, 0.3F});
  ASSERT_TRUE(account);
  EXPECT_EQ(account->total(), left);
  for (std::size_t i = 0; i < taken.size(); ++i)
    taken[i] = tree.clusters[i].nodes;
  const auto nothing = splatter.draw(scene, image, {taken, 0});
  ASSERT_TRUE(nothing);
  EXPECT_EQ(nothing->total(), 0U);
  EXPECT_TRUE(std::ranges::all_of(image.pixels, [](auto p) { return p == ui::empty_depth_pixel; }));
}

// Straight segments of a random direction, apart from each other on the screen, at one distance.
pipeline::VesselTree scattered(float radius_mm, float length_mm, std::uint8_t order,
                               std::uint64_t seed) {
  pipeline::VesselTree tree;
  std::mt19937_64 random{seed};
  std::uniform_real_distribution<float> turn{0, 2 * std::numbers::pi_v<float>};
  const auto add = [&](float x, float y, std::uint32_t parent) {
    tree.positions_mm.push_back({x, y, 0});
    tree.radii_mm.push_back(radius_mm);
    tree.parents.push_back(parent);
    tree.orders.push_back(order);
    tree.branches.push_back(pipeline::VesselBranch::lad);
  };
  for (int i = 0; i < 20; ++i)
    for (int j = 0; j < 20; ++j) {
      const float x = static_cast<float>(i) - 9.5F;
      const float y = static_cast<float>(j) - 9.5F;
      const float angle = turn(random);
      add(x, y, pipeline::no_parent);
      add(x + length_mm * std::cos(angle), y + length_mm * std::sin(angle),
          static_cast<std::uint32_t>(tree.nodes() - 1));
    }
  return tree;
}

// Covered area in pixels, on the average over places of the tree between the pixels.
double mean_coverage(const pipeline::VesselTree& tree, float detail_px, int places) {
  const auto arrays = pipeline::build_clusters(tree);
  const auto clusters = arrays.view();
  ui::Camera camera = camera_at(0, 3);
  camera.eye = {0, 0, 60};
  camera.forward = {0, 0, -1};
  camera.up = {0, 1, 0};
  ui::VesselScene scene = scene_of(clusters, camera);
  ui::Splatter splatter = make_splatter(0);
  ui::DepthImage image;
  std::mt19937_64 random{5};
  std::uniform_real_distribution<float> unit{-0.5F, 0.5F};
  double sum = 0;
  for (int i = 0; i < places; ++i) {
    scene.world_from_tree = glm::rotate(glm::mat4{1}, unit(random), glm::vec3{0, 0, 1});
    scene.world_from_tree[3] = {unit(random), unit(random), 0, 1};
    EXPECT_TRUE(splatter.draw(scene, image, {{}, detail_px}));
    for (const ui::DepthPixel pixel : image.pixels)
      sum += static_cast<double>(pixel >> 24U & 255U) / 255;
  }
  return sum / places;
}

double pixels_per_mm() {
  const ui::Camera camera = camera_at(0, 3);
  return height / 2.0 / double{camera.tan_half_height} / 60;
}

TEST(VesselSplatter, thin_vessels_cover_what_they_should_on_the_average) {
  const float length_mm = 0.4F;
  const double scale = pixels_per_mm();
  for (const float radius_px : {0.02F, 0.1F, 0.4F}) {
    const auto tree = scattered(radius_px / static_cast<float>(scale), length_mm, 1, 3);
    const double length_px = double{length_mm} * scale;
    const double r = double{radius_px};
    const double area = 400 * (2 * r * length_px + std::numbers::pi * r * r);
    const int places = 60;
    // As good as independent: each pixel centre is covered or not.
    const double sigma = std::sqrt(area / places);
    EXPECT_NEAR(mean_coverage(tree, 0, places), area, 4 * sigma) << radius_px;
  }
}

TEST(VesselSplatter, merging_keeps_the_coverage) {
  const float radius_px = 0.05F;
  const auto tree = scattered(radius_px / static_cast<float>(pixels_per_mm()), 0.4F, 1, 4);
  const int places = 60;
  const double all = mean_coverage(tree, 0, places);
  for (const float detail_px : {0.06F, 0.12F, 0.3F})
    EXPECT_NEAR(mean_coverage(tree, detail_px, places), all, 4 * std::sqrt(2 * all / places))
        << detail_px;
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

TEST(VesselSplatter, vessels_of_order_five_stay_connected_however_thin) {
  for (const std::uint8_t order : {std::uint8_t{4}, std::uint8_t{5}}) {
    pipeline::VesselTree tree;
    for (int i = 0; i < 30; ++i) {
      const float x = static_cast<float>(i) - 15;
      tree.positions_mm.push_back({x, 3 * std::sin(x * 0.3F), 0.2F * x});
      tree.radii_mm.push_back(0.01F);
      tree.parents.push_back(i == 0 ? pipeline::no_parent : static_cast<std::uint32_t>(i - 1));
      tree.orders.push_back(order);
      tree.branches.push_back(pipeline::VesselBranch::rca);
    }
    const auto arrays = pipeline::build_clusters(tree);
    const auto clusters = arrays.view();
    const ui::Camera camera = camera_at(0, 6);
    ui::Splatter splatter = make_splatter(0);
    ui::DepthImage image;
    ASSERT_TRUE(splatter.draw(scene_of(clusters, camera), image));
    int first = width;
    int last = -1;
    int columns = 0;
    for (int x = 0; x < width; ++x)
      for (int y = 0; y < height; ++y)
        if (image.at(x, y) != ui::empty_depth_pixel) {
          first = std::min(first, x);
          last = x;
          ++columns;
          break;
        }
    ASSERT_GT(last, first + 30);
    EXPECT_EQ(columns == last - first + 1, order == 5) << int{order};
  }
}

} // namespace
} // namespace octascope::tests
