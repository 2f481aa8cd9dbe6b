#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/calibration_finder/depth_power.h"

namespace octascope::pipeline {
namespace {

constexpr std::size_t samples = 512;

// Each line with a fringe of that amplitude at `bin`, its phase `phase_step` on from the last one's,
// on a background and in noise.
std::vector<double> b_scan(double amplitude, double bin, double phase_step,
                           std::size_t lines = 60) {
  std::mt19937 random{3};
  std::normal_distribution<double> noise{0, 5};
  std::vector<double> counts;
  for (std::size_t line = 0; line < lines; ++line)
    for (std::size_t p = 0; p < samples; ++p) {
      const double turn = static_cast<double>(p) / samples;
      counts.push_back(2000 * std::exp(-8 * (turn - 0.5) * (turn - 0.5)) +
                       amplitude * std::cos(2 * std::numbers::pi * bin * turn +
                                            phase_step * static_cast<double>(line)) +
                       noise(random));
    }
  return counts;
}

DepthPower::Highest highest_of(const std::vector<double>& counts) {
  DepthPower power{samples};
  power.add_b_scan(counts);
  power.add_b_scan(counts);
  return power.highest();
}

TEST(DepthPower, finds_what_scatters_and_how_deep) {
  const auto found = highest_of(b_scan(4, 90, 1));
  EXPECT_EQ(found.bin, 90U);
  EXPECT_GT(found.above_noise_db, 10);
}

TEST(DepthPower, of_noise_alone_is_little_above_it) {
  EXPECT_LT(highest_of(b_scan(0, 90, 1)).above_noise_db, 4);
}

TEST(DepthPower, takes_what_is_the_same_in_all_lines_for_background) {
  EXPECT_LT(highest_of(b_scan(40, 90, 0)).above_noise_db, 4);
}

TEST(DepthPower, is_none_without_light_and_without_lines) {
  EXPECT_EQ(highest_of(std::vector<double>(10 * samples, 7.0)).above_noise_db, 0);
  EXPECT_EQ(highest_of({}).above_noise_db, 0);
}

} // namespace
} // namespace octascope::pipeline
