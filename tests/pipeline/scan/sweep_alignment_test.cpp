#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/scan/sweep_alignment.h"

namespace octascope::pipeline {
namespace {

constexpr int depths = 16;

ScanPlan there_and_back() {
  ScanPlan plan;
  plan.samples = 2 * depths;
  plan.a_scans = 60;
  plan.bidirectional = true;
  plan.turn_around_lines = 12;
  return plan;
}

// Tissue without an end: a wave of 12 A-scans, of another phase at every depth.
double tissue(double a_scan, int depth) {
  return 120 + 60 * std::sin(2 * std::numbers::pi * (a_scan / 12 + depth / double{depths}));
}

// What the camera sees with a mirror that lags by `lag` lines.
std::vector<std::uint8_t> sweep(const ScanPlan& plan, double lag, bool backwards) {
  std::vector<std::uint8_t> lines;
  for (int line = 0; line < plan.lines_per_frame(); ++line) {
    const double place = backwards ? plan.a_scans - 1 - line + lag : line - lag;
    for (int z = 0; z < depths; ++z)
      lines.push_back(static_cast<std::uint8_t>(std::lround(tissue(place, z))));
  }
  return lines;
}

// Where an aligned A-scan lies, in A-scans from its index: the phase of the wave over depth.
double displacement(std::span<const std::uint8_t> a_scans, int a) {
  double s = 0;
  double c = 0;
  for (int z = 0; z < depths; ++z) {
    const double angle = 2 * std::numbers::pi * (a / 12.0 + z / double{depths});
    const double value = a_scans[static_cast<std::size_t>(a * depths + z)];
    s += value * std::cos(angle);
    c += value * std::sin(angle);
  }
  return std::atan2(s, c) * 12 / (2 * std::numbers::pi);
}

TEST(SweepAlignment, neighbouring_sweeps_agree_whatever_the_lag) {
  const ScanPlan plan = there_and_back();
  const auto size = static_cast<std::size_t>(plan.a_scans * depths);
  for (double lag = 0.5; lag <= 11.5; lag += 0.0625) {
    const SweepAlignment alignment{plan, lag};
    std::vector<std::uint8_t> forward(size);
    std::vector<std::uint8_t> backward(size);
    alignment.apply(sweep(plan, lag, false), false, forward);
    alignment.apply(sweep(plan, lag, true), true, backward);
    EXPECT_EQ(alignment.repeated_a_scans(), 0) << lag;
    for (int a = 0; a < plan.a_scans; ++a) {
      ASSERT_NEAR(displacement(forward, a), displacement(backward, a), 0.05) << lag << ", " << a;
      ASSERT_LE(std::abs(displacement(forward, a)), 0.55) << lag << ", " << a;
    }
  }
}

TEST(SweepAlignment, whole_and_half_lags_keep_every_level_as_it_came) {
  const ScanPlan plan = there_and_back();
  std::vector<std::uint8_t> a_scans(static_cast<std::size_t>(plan.a_scans * depths));
  const auto lines = sweep(plan, 0, false);
  for (const double lag : {0.0, 3.0, 3.5}) {
    SweepAlignment{plan, lag}.apply(lines, false, a_scans);
    const auto first = static_cast<std::ptrdiff_t>(lag) * depths;
    EXPECT_TRUE(std::equal(a_scans.begin(), a_scans.end(), lines.begin() + first)) << lag;
  }
}

TEST(SweepAlignment, both_directions_are_blurred_alike_and_little) {
  for (double lag = -3; lag <= 3; lag += 0.01) {
    const SweepAlignment alignment{there_and_back(), lag};
    const double forward = alignment.first_line(false);
    const double backward = alignment.first_line(true);
    EXPECT_NEAR(forward + backward, 2 * lag, 0.01);
    EXPECT_LE(std::abs(forward - std::round(forward)), 0.255) << lag;
    EXPECT_NEAR(forward - std::floor(forward), backward - std::floor(backward), 1e-12) << lag;
  }
}

TEST(SweepAlignment, repeats_the_outermost_line_where_there_are_no_more) {
  ScanPlan plan = there_and_back();
  plan.turn_around_lines = 2;
  const SweepAlignment alignment{plan, 5};
  EXPECT_EQ(alignment.repeated_a_scans(), 3);
  std::vector<std::uint8_t> a_scans(static_cast<std::size_t>(plan.a_scans * depths));
  const auto lines = sweep(plan, 5, true);
  alignment.apply(lines, true, a_scans);
  for (int a = 0; a < 4; ++a) { // backwards: the last lines are the first A-scans
    EXPECT_TRUE(std::equal(a_scans.begin() + a * depths, a_scans.begin() + (a + 1) * depths,
                           lines.end() - depths))
        << a;
  }
  EXPECT_EQ((SweepAlignment{plan, -4}.repeated_a_scans()), 4);
}

TEST(SweepAlignment, a_one_directional_scan_is_kept_as_it_is) {
  ScanPlan plan = there_and_back();
  plan.bidirectional = false;
  const SweepAlignment alignment{plan, 5};
  EXPECT_EQ(alignment.scan_lag_a_scans(), 0);
  EXPECT_EQ(alignment.first_line(false), 0);
}

} // namespace
} // namespace octascope::pipeline
