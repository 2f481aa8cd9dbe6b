// The real mirrors, and what is refused. Simulated ones, whose curves are known:
// calibrate_random_test.cpp.
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pipeline/calibration_finder/axial_psf.h"
#include "pipeline/calibration_finder/mirror_pair.h"
#include "pipeline/files/text_curve.h"
#include "tests/support/files/test_data.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

using testing::HasSubstr;

std::vector<float> spectrum(const std::string& name) {
  const auto values = read_float_curve(
      tests::test_data_folder() / "sd-oct-tissue" / (name + "_f32_1024.raw"), 1024);
  return values ? *values : std::vector<float>{};
}

std::vector<double> real_mirror(int mirror, bool with_darks) {
  const auto line = spectrum(fmt::format("mirror{}", mirror));
  const auto none = spectrum("dark_not");
  const auto sample = spectrum(fmt::format("dark_sample{}", mirror));
  const auto reference = spectrum("dark_ref");
  std::vector<double> rest(line.begin(), line.end());
  for (std::size_t p = 0; with_darks && p < rest.size(); ++p)
    rest[p] += static_cast<double>(none[p]) - static_cast<double>(sample[p]) -
               static_cast<double>(reference[p]);
  return rest;
}

TEST(MirrorPair, real_mirrors_become_sharp) {
  OCTASCOPE_REQUIRE_TEST_DATA("sd-oct-tissue/mirror1_f32_1024.raw");
  for (const bool darks : {true, false}) {
    const auto first = real_mirror(1, darks);
    const auto second = real_mirror(2, darks);
    for (const auto side : {SampleSide::both_mirrors, SampleSide::second_mirror}) {
      const auto found = tests::must(find_mirror_pair(first, second, side));
      Calibration calibration = Calibration::identity(1024);
      calibration.positions = found.positions;
      calibration.dispersion_rad = found.dispersion_rad;
      const auto clean_first = real_mirror(1, true);
      const auto clean_second = real_mirror(2, true);
      const double width_1 =
          measure_axial_psf(clean_first, calibration, found.theta_sign[0]).fwhm_bins;
      const double width_2 =
          measure_axial_psf(clean_second, calibration, found.theta_sign[1]).fwhm_bins;
      fmt::print("  real mirrors, darks {}: {:.2f} and {:.2f} bins at {:.1f} and {:.1f}; residual "
                 "{:.3f} {:.3f} rad, degrees {} {}; bright {}-{} {}-{}\n",
                 darks, width_1, width_2, found.depth_bins[0], found.depth_bins[1],
                 found.fringes[0].residual_rad, found.fringes[1].residual_rad,
                 found.fringes[0].phase_rad.degree(), found.fringes[1].phase_rad.degree(),
                 found.fringes[0].first_bright, found.fringes[0].last_bright,
                 found.fringes[1].first_bright, found.fringes[1].last_bright);
      EXPECT_LE(width_1, 2.5);
      EXPECT_LE(width_2, 2.5);
    }
  }
}

// Cosine of `fringes` over the line, under a bell.
std::vector<double> plain_fringe(double fringes, std::size_t samples = 512, double bend = 0) {
  std::vector<double> line(samples);
  for (std::size_t p = 0; p < samples; ++p) {
    const double t = static_cast<double>(p) / static_cast<double>(samples - 1);
    const double bell = std::exp(-std::pow((t - 0.5) / 0.25, 2) / 2);
    line[p] = 1000 * bell * std::cos(2 * std::numbers::pi * (fringes * t + bend * t * t));
  }
  return line;
}

std::string refusal(const std::vector<double>& first, const std::vector<double>& second) {
  const auto found = find_mirror_pair(first, second);
  return found ? "" : found.error().message;
}

TEST(MirrorPair, plain_fringes_are_accepted) {
  EXPECT_EQ(refusal(plain_fringe(40), plain_fringe(120)), "");
}

TEST(MirrorPair, refuses_the_same_depth_twice) {
  EXPECT_THAT(refusal(plain_fringe(60), plain_fringe(60.5)), HasSubstr("too close to each other"));
  EXPECT_THAT(refusal(plain_fringe(60), plain_fringe(60)), HasSubstr("expected at least 8"));
}

TEST(MirrorPair, refuses_what_is_no_number_with_its_index) {
  auto bad = plain_fringe(60);
  bad[137] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal(plain_fringe(120), bad), HasSubstr("second mirror: sample 137 is nan"));
}

TEST(MirrorPair, refuses_lines_without_a_fringe) {
  std::mt19937_64 generator{5};
  std::normal_distribution<double> normal;
  for (int round = 0; round < 20; ++round) {
    std::vector<double> noise(1024);
    for (double& value : noise)
      value = 1000 + 10 * normal(generator);
    EXPECT_THAT(refusal(noise, plain_fringe(60, 1024)), HasSubstr("no fringe"));
  }
  EXPECT_THAT(refusal(std::vector<double>(512, 7.0), plain_fringe(60)),
              HasSubstr("all samples are 7"));
  EXPECT_THAT(refusal(plain_fringe(60), plain_fringe(60, 256)), HasSubstr("512 samples"));
  EXPECT_THAT(refusal(plain_fringe(9, 48), plain_fringe(18, 48)), HasSubstr("at least 64"));
}

TEST(MirrorPair, refuses_a_difference_that_turns_back_with_its_pixel) {
  // The fringes of one slow down where those of the other do not: no spectrometer does that.
  EXPECT_THAT(refusal(plain_fringe(60), plain_fringe(130, 512, -55)),
              HasSubstr("wavenumber is not monotone"));
}

} // namespace
} // namespace octascope::pipeline
