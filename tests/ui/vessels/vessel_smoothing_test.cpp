// Outlines of the processor's vessels against exactly computed coverage, joints without seams, and what
// flickers from frame to frame.
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "pipeline/vessels/clusters/cluster_builder.h"
#include "sim/coronary_tree/coronary_tree.h"
#include "tests/support/vessels/random_tree.h"
#include "tests/ui/support/vessels/reference_segments.h"
#include "ui/vessels/splatter/splat_outline.h"
#include "ui/vessels/splatter/splatter.h"
#include "ui/vessels/view/vessel_flight.h"

namespace octascope::tests {
namespace {

constexpr int width = 160;
constexpr int height = 120;
constexpr float eye_mm = 60;

ui::Splatter make_splatter() {
  auto splatter = ui::Splatter::create(1, {});
  EXPECT_TRUE(splatter) << splatter.error().message;
  return std::move(*splatter);
}

// Along z, from 60 mm before the tree's origin.
ui::Camera straight_camera() {
  ui::Camera camera =
      ui::make_camera(ui::ViewState{}, {20, 20, 20}, static_cast<float>(width) / height);
  camera.eye = {0, 0, eye_mm};
  camera.forward = {0, 0, -1};
  camera.up = {0, 1, 0};
  camera.right = {1, 0, 0};
  return camera;
}

ui::VesselScene scene_of(const pipeline::VesselClusters& tree, const ui::Camera& camera) {
  ui::VesselScene scene{.tree = tree, .camera = camera, .look = {}};
  scene.width = width;
  scene.height = height;
  scene.look.cue_near_mm = 1;
  scene.look.cue_far_mm = 1000;
  return scene;
}

float mm_per_px() {
  const ui::Camera camera = straight_camera();
  return eye_mm * camera.tan_half_height / (0.5F * height);
}

// Straight, of that width everywhere, with nodes at uneven distances; 80 pixels long.
pipeline::VesselTree straight_vessel(float width_px, int parts) {
  pipeline::VesselTree tree;
  const float mm = mm_per_px();
  for (int i = 0; i <= parts; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(parts);
    const float uneven = share + 0.3F / static_cast<float>(parts) * std::sin(9 * share);
    tree.positions_mm.push_back({(i == parts ? 40 : -40 + 80 * uneven) * mm, 0, 0});
    tree.radii_mm.push_back(width_px / 2 * mm);
    tree.parents.push_back(i == 0 ? pipeline::no_parent : static_cast<std::uint32_t>(i - 1));
    tree.orders.push_back(4);
    tree.branches.push_back(pipeline::VesselBranch::lad);
  }
  return tree;
}

using Polygon = std::vector<glm::dvec2>;

// What of it lies on the side of the line where dot(normal, p) <= limit.
Polygon cut(const Polygon& polygon, const glm::dvec2& normal, double limit) {
  Polygon left;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 p = polygon[i];
    const glm::dvec2 q = polygon[(i + 1) % polygon.size()];
    const double at_p = glm::dot(normal, p) - limit;
    const double at_q = glm::dot(normal, q) - limit;
    if (at_p <= 0)
      left.push_back(p);
    if ((at_p < 0 && at_q > 0) || (at_p > 0 && at_q < 0))
      left.push_back(p + at_p / (at_p - at_q) * (q - p));
  }
  return left;
}

double area(const Polygon& polygon) {
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const glm::dvec2 p = polygon[i];
    const glm::dvec2 q = polygon[(i + 1) % polygon.size()];
    twice += p.x * q.y - p.y * q.x;
  }
  return std::abs(twice) / 2;
}

// The share of the pixel around `centre` within `radius` of the line through a and b.
double exact_coverage(const glm::dvec2& centre, const glm::dvec2& a, const glm::dvec2& b,
                      double radius) {
  const glm::dvec2 ahead = glm::normalize(b - a);
  const glm::dvec2 normal{-ahead.y, ahead.x};
  const double axis = glm::dot(normal, a);
  Polygon pixel;
  for (const auto& [x, y] : {std::pair{-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}, {-0.5, 0.5}})
    pixel.push_back(centre + glm::dvec2{x, y});
  return area(cut(cut(pixel, normal, axis + radius), -normal, radius - axis));
}

struct Profile {
  double worst = 0; // of a pixel, of coverage
  double mean = 0;  // of the pixels that an outline crosses
  int pixels = 0;   // of these
};

// Over angles and places between the pixels.
Profile profile(float width_px, int parts) {
  const auto arrays = pipeline::build_clusters(straight_vessel(width_px, parts));
  const auto tree = arrays.view();
  const ui::Camera camera = straight_camera();
  ui::Splatter splatter = make_splatter();
  ui::DepthImage image;
  Profile found;
  for (int turn = 0; turn < 45; ++turn) {
    ui::VesselScene scene = scene_of(tree, camera);
    scene.world_from_tree =
        glm::rotate(glm::mat4{1}, glm::radians(4.05F * static_cast<float>(turn)), {0, 0, 1});
    scene.world_from_tree[3] = {0.37F * mm_per_px() * static_cast<float>(turn % 7),
                                0.23F * mm_per_px() * static_cast<float>(turn % 5), 0, 1};
    EXPECT_TRUE(splatter.draw(scene, image));
    // Of the whole vessel, from the parts' extreme ends.
    const auto segments = reference_segments(scene);
    const glm::dvec2 way = segments.front().b - segments.front().a;
    const auto along_way = [&](const glm::dvec2& p) { return glm::dot(p, way); };
    glm::dvec2 a = segments.front().a;
    glm::dvec2 b = segments.front().b;
    for (const ReferenceSegment& s : segments) {
      a = along_way(s.a) < along_way(a) ? s.a : a;
      b = along_way(s.b) > along_way(b) ? s.b : b;
    }
    const glm::dvec2 ahead = glm::normalize(b - a);
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const glm::dvec2 centre{x + 0.5, y + 0.5};
        const double along = glm::dot(centre - a, ahead);
        if (along < 4 || along > glm::length(b - a) - 4)
          continue;
        const double expected = exact_coverage(centre, a, b, segments.front().ra);
        const double shown = (image.rgba(x, y) >> 24U) / 255.0;
        const double error = std::abs(shown - expected);
        found.worst = std::max(found.worst, error);
        if (expected > 0 && expected < 1) {
          found.mean += error;
          ++found.pixels;
        }
      }
  }
  found.mean /= found.pixels;
  return found;
}

TEST(VesselSmoothing, outlines_have_the_coverage_that_is_computed_exactly) {
  for (const float width_px : {1.5F, 2.0F, 3.0F, 4.0F, 7.0F, 20.0F})
    for (const int parts : {1, 17}) {
      const Profile found = profile(width_px, parts);
      fmt::print("  {} pixels wide, {} parts: off by {:.3f} of a pixel at most, {:.3f} on the "
                 "average\n",
                 width_px, parts, found.worst, found.mean);
      EXPECT_GT(found.pixels, 5000);
      EXPECT_LE(found.worst, 0.1) << width_px;
      EXPECT_LE(found.mean, 0.03) << width_px;
    }
}

// Where it runs away from the eye, its parts' sides and round ends overlap on the screen: none of them
// may be seen.
TEST(VesselSmoothing, a_wide_vessel_of_many_parts_looks_like_one_of_a_single_part) {
  const auto whole_arrays = pipeline::build_clusters(straight_vessel(24, 1));
  const auto parted_arrays = pipeline::build_clusters(straight_vessel(24, 6));
  const auto whole = whole_arrays.view();
  const auto parted = parted_arrays.view();
  const ui::Camera camera = straight_camera();
  ui::Splatter splatter = make_splatter();
  ui::DepthImage one;
  ui::DepthImage many;
  for (const float tilt_deg : {-45.0F, -30.0F, -15.0F, 0.0F, 15.0F, 30.0F, 45.0F}) {
    glm::mat4 place = glm::rotate(glm::mat4{1}, glm::radians(20.0F), {0, 0, 1});
    place = glm::rotate(place, glm::radians(tilt_deg), {0, 1, 0});
    ui::VesselScene scene = scene_of(whole, camera);
    scene.world_from_tree = place;
    ASSERT_TRUE(splatter.draw(scene, one));
    ui::VesselScene parted_scene = scene_of(parted, camera);
    parted_scene.world_from_tree = place;
    ASSERT_TRUE(splatter.draw(parted_scene, many));
    int worst = 0;
    int covered = 0;
    for (int y = 2; y < height - 2; ++y)
      for (int x = 2; x < width - 2; ++x) {
        // Beside outlines, how each part's round end bulges in perspective makes a difference.
        bool is_within = true;
        for (int i = 0; i < 25; ++i)
          is_within = is_within && one.rgba(x + i % 5 - 2, y + i / 5 - 2) >> 24U == 255U;
        if (!is_within)
          continue;
        ++covered;
        for (const unsigned shift : {0U, 8U, 16U})
          worst = std::max(worst, std::abs(static_cast<int>(one.rgba(x, y) >> shift & 255U) -
                                           static_cast<int>(many.rgba(x, y) >> shift & 255U)));
      }
    fmt::print("  tilted by {} degrees: {} of 255 apart at most\n", tilt_deg, worst);
    EXPECT_GT(covered, 500);
    EXPECT_LE(worst, 5) << tilt_deg;
  }
}

// The pass in double precision: each pixel of the sharp picture takes of its neighbours what the
// nearer one's outline says, along the row and then along the column.
class ReferenceSmoothing {
public:
  explicit ReferenceSmoothing(const ui::DepthImage& sharp) : sharp_{sharp} {}

  // Red, green, blue, opacity; 0…255.
  glm::dvec4 along_both(int x, int y) const {
    const auto row = [&](int dy) { return along_row(x, y + dy); };
    return mixed({x, y}, {0, 1}, row(-1), row(0), row(1));
  }

private:
  glm::ivec2 within(const glm::ivec2& at) const {
    return {std::clamp(at.x, 0, sharp_.width - 1), std::clamp(at.y, 0, sharp_.height - 1)};
  }
  ui::DepthPixel pixel(const glm::ivec2& at) const {
    const glm::ivec2 p = within(at);
    return sharp_.at(p.x, p.y);
  }
  static float distance(ui::DepthPixel pixel) {
    return std::bit_cast<float>(static_cast<std::uint32_t>(pixel >> 32U));
  }
  glm::dvec4 colour(const glm::ivec2& at) const {
    const glm::ivec2 p = within(at);
    const std::uint32_t rgb = sharp_.rgba(p.x, p.y);
    return {rgb & 255U, rgb >> 8U & 255U, rgb >> 16U & 255U,
            std::isinf(sharp_.distance_mm(p.x, p.y)) ? 0 : 255};
  }
  glm::dvec4 along_row(int x, int y) const {
    return mixed({x, y}, {1, 0}, colour({x - 1, y}), colour({x, y}), colour({x + 1, y}));
  }
  glm::dvec4 mixed(const glm::ivec2& at, const glm::ivec2& step, const glm::dvec4& before,
                   const glm::dvec4& here, const glm::dvec4& after) const {
    const double first = taken(at, -step);
    const double second = taken(at, step);
    return (1 - first - second) * here + first * before + second * after;
  }
  // How much the pixel takes from its neighbour.
  double taken(const glm::ivec2& at, const glm::ivec2& step) const {
    const ui::DepthPixel here = pixel(at);
    const ui::DepthPixel there = pixel(at + step);
    if (within(at + step) == within(at))
      return 0; // the border
    // Of equally near ones, the upper or the left one.
    const bool is_nearer =
        (here >> 32U) != (there >> 32U) ? (here >> 32U) < (there >> 32U) : step.x + step.y > 0;
    const ui::SplatOutline outline = ui::outline_of(is_nearer ? here : there);
    if (outline == 0)
      return std::isinf(distance(is_nearer ? here : there)) ? 0 : 0.25;
    const bool row = (outline & ui::outline_sideways) != 0;
    const bool towards_second = (step.x + step.y > 0) == is_nearer;
    const unsigned steps = (towards_second ? outline : outline >> 5U) & 31U;
    if (row != (step.x != 0) || steps == 31)
      return 0;
    const double px = (steps + 0.5) / 30;
    const double tail = (outline & ui::outline_oblique) != 0 ? 0.75 : 0.25;
    return beyond(is_nearer ? px : 1 - px, tail);
  }
  static double beyond(double px, double tail) {
    constexpr int lines = 4000;
    double sum = 0;
    for (int i = 0; i < lines; ++i)
      sum += std::clamp(0.5 - px + tail * ((i + 0.5) / lines - 0.5), 0.0, 1.0);
    return sum / lines;
  }

  const ui::DepthImage& sharp_;
};

TEST(VesselSmoothing, is_the_pass_computed_in_double_precision_with_every_instruction_set) {
  const auto arrays = pipeline::build_clusters(random_tree(3000, 41));
  const auto tree = arrays.view();
  ui::ViewState view;
  view.yaw_deg = 40;
  view.distance = 2;
  const ui::Camera camera = ui::make_camera(view, {20, 20, 20}, static_cast<float>(width) / height);
  for (const char* isa : {"AVX3", "AVX2", "SSE4", "NEON", "EMU128"}) {
    auto splatter = ui::Splatter::create(1, {}, isa);
    if (!splatter)
      continue;
    ui::DepthImage image;
    ASSERT_TRUE(splatter->draw(scene_of(tree, camera), image));
    const ReferenceSmoothing reference{splatter->sharp()};
    int mixed = 0;
    int wrong = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const glm::dvec4 expected = reference.along_both(x, y);
        const std::uint32_t shown = image.rgba(x, y);
        for (int i = 0; i < 4; ++i)
          wrong += std::abs((shown >> (8 * i) & 255U) - expected[i]) > 4; // weights of 1 / 64
        mixed += (shown & 0xFFFFFFU) != (splatter->sharp().rgba(x, y) & 0xFFFFFFU);
        ASSERT_EQ(std::isinf(image.distance_mm(x, y)),
                  std::isinf(splatter->sharp().distance_mm(x, y)));
      }
    EXPECT_EQ(wrong, 0) << isa;
    EXPECT_GT(mixed, 1000) << isa;
  }
}

TEST(VesselSmoothing, within_a_volume_what_ends_a_ray_is_opaque) {
  pipeline::VesselTree mixed = random_tree(3000, 42);
  for (const bool thin : {false, true}) {
    for (std::size_t i = 0; thin && i < mixed.nodes(); ++i) {
      mixed.radii_mm[i] = 0.06F;
      mixed.orders[i] = 3;
    }
    const auto arrays = pipeline::build_clusters(mixed);
    const auto tree = arrays.view();
    const ui::Camera camera = straight_camera();
    ui::Splatter splatter = make_splatter();
    ui::DepthImage image;
    ASSERT_TRUE(splatter.draw(scene_of(tree, camera), image, {.taken = {}, .within_volume = true}));
    int covered = 0;
    int beside = 0;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const std::uint32_t opacity = image.rgba(x, y) >> 24U;
        const bool vessel = !std::isinf(splatter.sharp().distance_mm(x, y));
        covered += vessel;
        beside += !vessel && opacity > 0;
        if (vessel) {
          ASSERT_EQ(opacity, 255U);
        }
      }
    EXPECT_GT(covered, 300);
    EXPECT_EQ(beside > 0, !thin);
  }
}

// Sharp pictures and smoothed ones, beside the mean of sharp ones at 8 × 8 places within each
// pixel, which is what does not flicker.
using Picture = std::vector<double>; // red, green, blue

Picture shown(const ui::DepthImage& image) {
  Picture picture;
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (unsigned shift : {0U, 8U, 16U})
        picture.push_back(image.rgba(x, y) >> shift & 255U);
  return picture;
}

double change(const Picture& a, const Picture& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    sum += std::abs(a[i] - b[i]);
  return sum / static_cast<double>(a.size());
}

// What changes from one picture to the next and does not in the means, in amount and in softness.
double off_the_means(const Picture& from, const Picture& to, const Picture& mean_from,
                     const Picture& mean_to) {
  double sum = 0;
  for (std::size_t i = 0; i < from.size(); ++i)
    sum += std::abs((to[i] - from[i]) - (mean_to[i] - mean_from[i]));
  return sum / static_cast<double>(from.size());
}

class Flight {
public:
  explicit Flight(const pipeline::VesselClusters& tree)
      : tree_{tree}, bounds_{ui::vessel_bounds(tree)}, flight_{tree, width, height} {}

  const ui::VesselFlight& path() const { return flight_; }

  struct Frame {
    Picture sharp, smooth, mean;
  };
  Frame at(float t) {
    const ui::VesselView view = flight_.at(t);
    Frame frame;
    draw(view);
    frame.sharp = shown(splatter_.sharp());
    frame.smooth = shown(image_);
    frame.mean.assign(frame.sharp.size(), 0);
    constexpr int places = 8;
    for (int i = 0; i < places; ++i)
      for (int j = 0; j < places; ++j) {
        const auto part = [](int k) { return (static_cast<float>(k) + 0.5F) / places - 0.5F; };
        draw(view, part(i), part(j));
        const Picture sample = shown(splatter_.sharp());
        for (std::size_t k = 0; k < sample.size(); ++k)
          frame.mean[k] += sample[k] / (places * places);
      }
    return frame;
  }

private:
  void draw(const ui::VesselView& view, float right_px = 0, float up_px = 0) {
    camera_ =
        ui::turned(ui::make_vessel_camera(view, bounds_, width, height), right_px, up_px, height);
    ui::VesselScene scene{tree_, camera_, glm::mat4{1}, {}, width, height};
    scene.look = ui::with_cue(scene.look, view, bounds_, width, height);
    EXPECT_TRUE(splatter_.draw(scene, image_));
  }

  const pipeline::VesselClusters& tree_;
  ui::VesselBounds bounds_;
  ui::VesselFlight flight_;
  ui::Splatter splatter_ = make_splatter();
  ui::DepthImage image_;
  ui::Camera camera_;
};

// From frame to frame even an exact picture changes, since the eye moves: by more than half of what the
// sharp one does. Flicker is what a picture changes by beyond that. A soft picture would change less,
// so that it is nearer to the exact ones, too, is asked for beside it.
TEST(VesselSmoothing, halves_the_flicker_of_a_flight) {
  auto grown = sim::generate_coronary_tree({60000, 1, 2});
  ASSERT_TRUE(grown);
  // A heart of so few segments ends at order 5: counted from below, there are thin ones, too.
  const std::uint8_t lowest = *std::ranges::min_element(grown->tree.orders);
  for (std::uint8_t& order : grown->tree.orders)
    order = static_cast<std::uint8_t>(order - lowest);
  const auto arrays = pipeline::build_clusters(grown->tree);
  const auto tree = arrays.view();
  Flight flight{tree};
  const float step = 0.5F / flight.path().pixels();
  double sharp = 0, smooth = 0, exact_change = 0, sharp_change = 0, smooth_change = 0;
  double off_sharp = 0, off_smooth = 0;
  constexpr int places = 9;
  for (int i = 0; i < places; ++i) {
    const float t = (1 - step) * static_cast<float>(i) / (places - 1);
    const auto a = flight.at(t);
    const auto b = flight.at(t + step);
    sharp += off_the_means(a.sharp, b.sharp, a.mean, b.mean) / places;
    smooth += off_the_means(a.smooth, b.smooth, a.mean, b.mean) / places;
    exact_change += change(a.mean, b.mean) / places;
    sharp_change += change(a.sharp, b.sharp) / places;
    smooth_change += change(a.smooth, b.smooth) / places;
    off_sharp += change(a.sharp, a.mean) / places;
    off_smooth += change(a.smooth, a.mean) / places;
  }
  fmt::print(
      "  change from frame to frame {:.3f} of 255, sharp {:.3f}, exact {:.3f}; off the exact "
      "change {:.3f}, sharp {:.3f}; off the exact picture {:.3f}, sharp {:.3f}\n",
      smooth_change, sharp_change, exact_change, smooth, sharp, off_smooth, off_sharp);
  EXPECT_GT(exact_change, 0.5 * sharp_change);
  EXPECT_LE(smooth_change - exact_change, 0.4 * (sharp_change - exact_change));
  EXPECT_LE(smooth, 0.615 * sharp);
  EXPECT_LE(off_smooth, 0.615 * off_sharp);
}

} // namespace
} // namespace octascope::tests
