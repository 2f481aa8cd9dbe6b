#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/calibration_finder/target.h"
#include "tests/support/fails_with.h"

namespace octascope::pipeline {
namespace {

using tests::FailsWith;

struct EnFace {
  int a_scans = 0;
  int b_scans = 0;
  std::vector<float> levels; // [b][a]

  float& at(int a, int b) { return levels[static_cast<std::size_t>(b * a_scans + a)]; }
};

constexpr double side_um = 2400;

// Its upper left corner at (`left`, `top`) µm, turned about that by `tilt_degrees`, in noise.
EnFace scan(double a_um, double b_um, int a_scans, int b_scans, double left = 300, double top = 260,
            double tilt_degrees = 0, float noise_db = 2) {
  std::mt19937 random{1};
  std::normal_distribution<float> noise{0, noise_db};
  const double cosine = std::cos(tilt_degrees * std::numbers::pi / 180);
  const double sine = std::sin(tilt_degrees * std::numbers::pi / 180);
  EnFace picture{
      a_scans, b_scans,
      std::vector<float>(static_cast<std::size_t>(a_scans) * static_cast<std::size_t>(b_scans))};
  const double unit_um = side_um / target_units;
  for (int b = 0; b < b_scans; ++b)
    for (int a = 0; a < a_scans; ++a) {
      const double x = (a * a_um - left) / unit_um;
      const double y = (b * b_um - top) / unit_um;
      const bool light = target_reflects(x * cosine + y * sine, y * cosine - x * sine);
      picture.at(a, b) = (light ? 30.0F : 5.0F) + noise(random);
    }
  return picture;
}

EnFace mirrored(EnFace picture) {
  for (int b = 0; b < picture.b_scans; ++b)
    std::reverse(&picture.at(0, b), &picture.at(0, b) + picture.a_scans);
  return picture;
}

// Clockwise: what was the left column, from below, becomes the top row.
EnFace turned(EnFace picture) {
  EnFace result{picture.b_scans, picture.a_scans, picture.levels};
  for (int b = 0; b < result.b_scans; ++b)
    for (int a = 0; a < result.a_scans; ++a)
      result.at(a, b) = picture.at(b, picture.b_scans - 1 - a);
  return result;
}

hal::Result<TargetMeasurement> measure(const EnFace& picture) {
  return measure_target(picture.levels, picture.a_scans, picture.b_scans, side_um);
}

TEST(Target, drawing_has_an_f_and_bars_that_touch_all_sides) {
  EXPECT_TRUE(target_reflects(1, 11));     // stem
  EXPECT_FALSE(target_reflects(1, 13));    // below it
  EXPECT_TRUE(target_reflects(10, 1));     // upper arm
  EXPECT_TRUE(target_reflects(7, 6));      // middle arm
  EXPECT_FALSE(target_reflects(9, 6));     // which is shorter
  EXPECT_TRUE(target_reflects(0.5, 19.5)); // bars reach the lower left corner
  EXPECT_FALSE(target_reflects(2.5, 16));
  EXPECT_TRUE(target_reflects(19.5, 0.5)); // the right ones both
  EXPECT_TRUE(target_reflects(19.5, 19.5));
  EXPECT_FALSE(target_reflects(17, 2.5));
  EXPECT_FALSE(target_reflects(-0.1, 1));
  EXPECT_FALSE(target_reflects(20.1, 1));
}

TEST(Target, is_measured_all_eight_ways_round) {
  for (const bool mirror : {false, true}) {
    EnFace picture = scan(10, 37.5, 300, 80);
    if (mirror)
      picture = mirrored(std::move(picture));
    for (int turns = 0; turns < 4; ++turns, picture = turned(picture)) {
      const auto found = measure(picture);
      ASSERT_TRUE(found) << found.error().message;
      EXPECT_EQ(found->mirrored, mirror) << turns;
      EXPECT_EQ(found->quarter_turns, turns) << mirror;
      EXPECT_EQ(found->upright(), !mirror && turns == 0);
      EXPECT_NEAR(found->a_spacing_um, turns % 2 == 0 ? 10 : 37.5, turns % 2 == 0 ? 0.1 : 0.6);
      EXPECT_NEAR(found->b_spacing_um, turns % 2 == 0 ? 37.5 : 10, turns % 2 == 0 ? 0.6 : 0.1);
    }
  }
}

TEST(Target, tells_spacings_that_are_not_what_was_thought) {
  for (const double a_um : {9.0, 11.5, 14.0})
    for (const double b_um : {20.0, 33.0}) {
      const auto found = measure(scan(a_um, b_um, 340, 150));
      ASSERT_TRUE(found) << found.error().message;
      EXPECT_NEAR(found->a_spacing_um, a_um, 0.01 * a_um);
      EXPECT_NEAR(found->b_spacing_um, b_um, 0.01 * b_um);
    }
}

// In a field of 200 × 200, `share` of which it spans.
hal::Result<TargetMeasurement> measure_in_field(double share, double tilt_degrees, float noise_db) {
  constexpr int scans = 200;
  const double field_um = side_um / share;
  const double margin_um = (field_um - side_um) / 2;
  return measure(scan(field_um / scans, field_um / scans, scans, scans, margin_um, margin_um,
                      tilt_degrees, noise_db));
}

TEST(Target, is_found_in_a_field_of_its_own_width_up_to_one_five_times_as_wide) {
  for (const double share : {0.2, 0.24, 0.35, 0.5, 0.7, 0.9, 0.97, 1.0})
    for (const double tilt : {-2.0, 0.0, 2.0})
      for (const float noise : {1.0F, 4.0F}) {
        const auto found = measure_in_field(share, tilt, noise);
        ASSERT_TRUE(found) << share << " " << tilt << ": " << found.error().message;
        const double um = side_um / share / 200;
        EXPECT_TRUE(found->upright()) << share << " " << tilt << " " << noise;
        EXPECT_NEAR(found->a_spacing_um, um, 0.03 * um) << share << " " << tilt << " " << noise;
        EXPECT_NEAR(found->b_spacing_um, um, 0.03 * um) << share << " " << tilt << " " << noise;
      }
}

TEST(Target, says_why_it_is_probably_not_found) {
  EXPECT_THAT(measure(scan(40, 150, 300, 80, 4000, 4000)), // 12 mm wide
              FailsWith(hal::ErrorCode::bad_data, "It is too small in this field: a bar is 1.6 B"));
  EXPECT_THAT(measure_in_field(1.4, 0, 2), FailsWith(hal::ErrorCode::bad_data, "It reaches the"));
  EXPECT_THAT(measure_in_field(0.6, 20, 2),
              FailsWith(hal::ErrorCode::bad_data, "turned by a few degrees at most"));
}

TEST(Target, says_what_it_means_in_words) {
  EXPECT_EQ(orientation_text({}), "upright");
  EXPECT_EQ(orientation_text({.quarter_turns = 3}), "turned by 270° clockwise");
  EXPECT_EQ(orientation_text({.mirrored = true}), "mirrored left for right");
  EXPECT_EQ(orientation_text({.mirrored = true, .quarter_turns = 1}),
            "mirrored left for right and turned by 90° clockwise");
}

TEST(Target, refuses_what_is_none) {
  EnFace empty = scan(10, 37.5, 300, 80, 1e6, 1e6);
  EXPECT_THAT(measure(empty), FailsWith(hal::ErrorCode::bad_data, "no target"));
  EXPECT_THAT(measure(scan(10, 37.5, 300, 80, -600)),
              FailsWith(hal::ErrorCode::bad_data, "reaches the first A-scan"));
  EXPECT_THAT(measure(scan(10, 37.5, 300, 80, 300, 1000)),
              FailsWith(hal::ErrorCode::bad_data, "reaches the last B-scan"));
  EnFace square = scan(10, 37.5, 300, 80, 1e6, 1e6);
  for (int b = 20; b < 60; ++b)
    for (int a = 80; a < 220; ++a)
      square.at(a, b) += 25;
  EXPECT_THAT(measure(square), FailsWith(hal::ErrorCode::bad_data, "is not the target"));
}

} // namespace
} // namespace octascope::pipeline
