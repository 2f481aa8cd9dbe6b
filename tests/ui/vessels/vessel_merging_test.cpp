// Merged vessels beside all of them: on the average the same picture, and none that flickers.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pipeline/vessels/clusters/cluster_builder.h"
#include "tests/support/vessels/random_tree.h"
#include "ui/vessels/splatter/splatter.h"

namespace octascope::tests {
namespace {

constexpr int width = 320;
constexpr int height = 180;
constexpr std::size_t values = std::size_t{width} * height * 3;

// Vessels that may all be merged, thinner than a pixel, and enough to fill the picture.
pipeline::VesselTree thin_tree() {
  pipeline::VesselTree tree = random_tree(30000, 31);
  for (std::size_t i = 0; i < tree.nodes(); ++i) {
    tree.orders[i] = std::min<std::uint8_t>(tree.orders[i], 3);
    tree.radii_mm[i] = 0.012F + 0.006F * static_cast<float>(tree.orders[i]);
  }
  return tree;
}

class VesselMerging : public ::testing::Test {
protected:
  void SetUp() override {
    auto splatter = ui::Splatter::create(1, {});
    ASSERT_TRUE(splatter) << splatter.error().message;
    splatter_.emplace(std::move(*splatter));
  }

  // From `distance` sizes of the tree, the picture moved by so many pixels; 0…255, red, green,
  // blue.
  std::vector<float> draw(float detail_px, float yaw_deg, float distance = 2.2F, float right_px = 0,
                          float up_px = 0) {
    ui::ViewState view;
    view.yaw_deg = yaw_deg;
    view.tilt_deg = 20;
    view.distance = distance;
    ui::Camera camera = ui::make_camera(view, {20, 20, 20}, float{width} / height);
    ui::VesselScene scene{.tree = tree_, .camera = camera, .look = {}};
    scene.width = width;
    scene.height = height;
    scene.look.cue_near_mm = camera.near_mm;
    scene.look.cue_far_mm = camera.far_mm;
    const float mm = camera.depth_of({0, 0, 0}) / scene.pixels_per_unit();
    camera.eye += mm * (right_px * camera.right + up_px * camera.up);
    const auto account = splatter_->draw(scene, image_, {{}, detail_px});
    EXPECT_TRUE(account);
    EXPECT_EQ(account->total(), tree_.segments);
    merged_ = account->merged;
    std::vector<float> picture;
    picture.reserve(values);
    for (std::size_t i = 0; i < values; ++i)
      picture.push_back(static_cast<float>(image_.pixels[i / 3] >> (8 * (i % 3)) & 255U));
    return picture;
  }

  // Over pictures moved by parts of a pixel: what is thinner than a pixel becomes a grey.
  std::vector<float> average(float detail_px) {
    constexpr int count = 8;
    std::vector<float> sum(values, 0.0F);
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count; ++j) {
        const auto part = [](int k) { return (static_cast<float>(k) + 0.5F) / count - 0.5F; };
        const auto picture = draw(detail_px, 0, 2.2F, part(i), part(j));
        for (std::size_t k = 0; k < values; ++k)
          sum[k] += picture[k] / (count * count);
      }
    return sum;
  }

  static double difference(const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < values; ++i)
      sum += std::abs(double{a[i]} - double{b[i]});
    return sum / static_cast<double>(values);
  }

  static double mean(const std::vector<float>& picture) {
    return std::reduce(picture.begin(), picture.end(), 0.0) / static_cast<double>(values);
  }

  std::optional<ui::Splatter> splatter_;
  ui::DepthImage image_;
  std::uint64_t merged_ = 0;
  pipeline::ClusterArrays arrays_ = pipeline::build_clusters(thin_tree());
  pipeline::VesselClusters tree_ = arrays_.view();
};

TEST_F(VesselMerging, shows_the_same_on_the_average) {
  const auto all = average(0);
  for (const float detail_px : {0.2F, 0.4F}) {
    const auto merged = average(detail_px);
    EXPECT_GT(merged_, tree_.segments / 8);
    const double found = difference(merged, all);
    fmt::print("  detail {} px: {} of {} merged, {:.2f}/255 from the average of all\n", detail_px,
               merged_, tree_.segments, found);
    EXPECT_LE(found, 2) << detail_px;
    EXPECT_NEAR(mean(merged), mean(all), 0.02 * mean(all)) << detail_px;
  }
}

// The bound: of frame to frame, no more than a quarter above what drawing all of them differs by
// in the same steps; and no step stands out from the others by half as much again.
TEST_F(VesselMerging, changes_no_more_from_frame_to_frame_than_all_vessels_do) {
  constexpr int steps = 40;
  const auto flight = [&](float detail_px) {
    std::vector<double> differences;
    std::vector<float> before;
    for (int i = 0; i <= steps; ++i) {
      const auto t = static_cast<float>(i) / steps;
      auto picture = draw(detail_px, 8 * t, 2.4F - 0.4F * t);
      if (!before.empty())
        differences.push_back(difference(picture, before));
      before = std::move(picture);
    }
    return differences;
  };
  const auto all = flight(0);
  const double most = *std::ranges::max_element(all);
  for (const float detail_px : {0.1F, 0.2F, 0.4F}) {
    auto merged = flight(detail_px);
    std::ranges::sort(merged);
    fmt::print(
        "  detail {} px: {:.2f}/255 from frame to frame, at most {:.2f}; all: at most {:.2f}\n",
        detail_px, merged[steps / 2], merged.back(), most);
    EXPECT_LE(merged.back(), 1.25 * most) << detail_px;
    EXPECT_LE(merged.back(), 1.5 * merged[steps / 2]) << detail_px;
  }
}

TEST_F(VesselMerging, comes_and_goes_without_a_jump) {
  // The governor moves by a tenth at the most on its way down: here in hundredths, to where they all
  // have become a pixel wide, and with it have got outlines.
  std::vector<float> before = draw(0, 0);
  double most = 0;
  double most_of_thin = 0;
  int steps = 0;
  for (float detail_px = 0.02F; detail_px < 0.8F; detail_px *= 1.01F, ++steps) {
    auto picture = draw(detail_px, 0);
    most = std::max(most, difference(picture, before));
    if (detail_px < 0.45F)
      most_of_thin = most;
    before = std::move(picture);
  }
  const double all_at_once = difference(before, draw(0, 0));
  fmt::print(
      "  {} steps of a hundredth: at most {:.2f}/255, while thinner than a pixel {:.2f}/255; in "
      "one: {:.2f}/255\n",
      steps, most, most_of_thin, all_at_once);
  EXPECT_LE(most, 0.15 * all_at_once);
  EXPECT_LE(most_of_thin, 0.05 * all_at_once);
  EXPECT_GT(all_at_once, 1);
}

TEST_F(VesselMerging, is_the_same_with_every_instruction_set) {
  const auto expected = draw(0.3F, 30);
  const std::uint64_t merged = merged_;
  EXPECT_GT(merged, 0U);
  for (const char* isa : {"AVX3", "AVX2", "SSE4", "NEON", "EMU128"}) {
    auto splatter = ui::Splatter::create(0, {}, isa);
    if (!splatter)
      continue;
    splatter_.emplace(std::move(*splatter));
    // Roundings differ, and with them a pixel here and there at a vessel's edge.
    EXPECT_LE(difference(draw(0.3F, 30), expected), 0.01) << isa;
    EXPECT_EQ(merged_, merged) << isa;
  }
}

} // namespace
} // namespace octascope::tests
