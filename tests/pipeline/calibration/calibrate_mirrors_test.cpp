// Mirrors of a spectrometer whose chirp and dispersion are known, through noise: the curves that
// are found against the true ones, and the real mirrors.
#include <algorithm>
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
#include "sim/spectrometer/spectrometer.h"
#include "tests/support/files/test_data.h"

namespace octascope::pipeline {
namespace {

using testing::HasSubstr;

struct Case {
  const char* name;
  int samples;
  double bow;
  double skew;
  double quadratic_rad;
  double cubic_rad;
  double first_bin;
  double second_bin;
  bool dark;
  std::uint64_t seed;
};

void PrintTo(const Case& c, std::ostream* out) {
  *out << c.name;
}

// One camera line with its noise, rounded and saturated, with or without the dark subtracted.
std::vector<double> mirror_line(const sim::Spectrometer& s, const Case& c, double bin,
                                bool mirrored, std::uint64_t seed) {
  // A mirror beyond zero delay: cos(−2π·d·m/N − θ).
  const sim::Reflector mirror{mirrored ? -bin : bin, 500, 0.7};
  const std::vector<double> mean = s.mean_counts({&mirror, 1});
  const std::vector<double> light = s.mean_counts({});
  std::mt19937_64 generator{seed};
  std::normal_distribution<double> normal;
  std::vector<double> line(mean.size());
  for (std::size_t p = 0; p < line.size(); ++p) {
    const double variance = mean[p] / s.config().electrons_per_count +
                            s.config().read_noise_counts * s.config().read_noise_counts;
    line[p] =
        std::clamp(std::round(mean[p] + std::sqrt(variance) * normal(generator)), 0.0, 4095.0);
    if (c.dark)
      line[p] -= light[p];
  }
  return line;
}

struct Line {
  double offset = 0;
  double slope = 0;
};

Line straight(const std::vector<double>& x, const std::vector<double>& y) {
  double mx = 0;
  double my = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    mx += x[i] / static_cast<double>(x.size());
    my += y[i] / static_cast<double>(x.size());
  }
  double xx = 0;
  double xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    xx += (x[i] - mx) * (x[i] - mx);
    xy += (x[i] - mx) * (y[i] - my);
  }
  return {my - mx * xy / xx, xy / xx};
}

double rms_from_line(const std::vector<double>& x, const std::vector<double>& y) {
  const Line line = straight(x, y);
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    sum += std::pow(y[i] - line.offset - line.slope * x[i], 2);
  return std::sqrt(sum / static_cast<double>(x.size()));
}

struct Errors {
  double positions_px = 0;
  double dispersion_rad = 0;
};

// Over the central 80 %. Found sample m stands for the true sample k(r[m]): a straight line of it
// (offset and scale of k) is free, as is one of the phase (offset and scale of depth). What k is
// off by is brought to pixels by the slope of r.
Errors errors(const MirrorPair& found, const sim::Spectrometer& s) {
  const std::size_t n = found.positions.size();
  std::vector<double> m_found;
  std::vector<double> m_true;
  std::vector<double> theta_error;
  double slope = 0;
  for (std::size_t m = n / 10; m < n - n / 10; ++m) {
    const auto p = static_cast<std::size_t>(found.positions[m]);
    const double f = found.positions[m] - static_cast<double>(p);
    const auto blend = [&](const std::vector<double>& v) { return v[p] + f * (v[p + 1] - v[p]); };
    m_found.push_back(static_cast<double>(m));
    m_true.push_back(blend(s.k_of_pixel()));
    theta_error.push_back(found.dispersion_rad[m] - blend(s.dispersion_of_pixel_rad()));
    slope = std::max(slope, found.positions[m + 1] - found.positions[m]);
  }
  return {rms_from_line(m_found, m_true) * slope, rms_from_line(m_true, theta_error)};
}

sim::Spectrometer spectrometer(const Case& c) {
  sim::SpectrometerConfig config;
  config.samples = c.samples;
  config.chirp_bow = c.bow;
  config.chirp_skew = c.skew;
  config.dispersion_quadratic_rad = c.quadratic_rad;
  config.dispersion_cubic_rad = c.cubic_rad;
  config.seed = c.seed;
  return *sim::Spectrometer::make(config);
}

class Mirrors : public testing::TestWithParam<Case> {};

TEST_P(Mirrors, give_the_true_curves) {
  const Case& c = GetParam();
  const sim::Spectrometer s = spectrometer(c);
  const auto first = mirror_line(s, c, c.first_bin, false, c.seed);
  const auto second = mirror_line(s, c, c.second_bin, false, c.seed + 1);
  const auto found = find_mirror_pair(first, second);
  ASSERT_TRUE(found) << found.error().message;
  const Errors e = errors(*found, s);
  fmt::print("  {}: r {:.4f} px rms, theta {:.4f} rad rms, depths {:.2f} and {:.2f}\n", c.name,
             e.positions_px, e.dispersion_rad, found->depth_bins[0], found->depth_bins[1]);
  EXPECT_LE(e.positions_px, 0.05);
  EXPECT_LE(e.dispersion_rad, 0.05);
  EXPECT_NEAR(found->depth_bins[1] - found->depth_bins[0], c.second_bin - c.first_bin, 0.5);

  Calibration calibration = Calibration::identity(c.samples);
  calibration.positions = found->positions;
  calibration.dispersion_rad = found->dispersion_rad;
  EXPECT_LE(measure_axial_psf(remove_slow_part(first), calibration).fwhm_bins, 3.2);
  EXPECT_LE(measure_axial_psf(remove_slow_part(second), calibration).fwhm_bins, 3.2);
}

INSTANTIATE_TEST_SUITE_P(
    Spectrometers, Mirrors,
    testing::Values(Case{"default_dark", 1024, 70.0 / 1024, 0.1, 25, 6, 60, 200, true, 1},
                    Case{"default_no_dark", 1024, 70.0 / 1024, 0.1, 25, 6, 60, 200, false, 2},
                    Case{"deeper_first", 1024, 70.0 / 1024, 0.1, 25, 6, 240, 80, true, 3},
                    Case{"no_dispersion", 1024, 0.05, -0.15, 0, 0, 50, 180, true, 4},
                    Case{"bent_other_way", 1024, -0.06, 0.1, -20, 4, 70, 220, true, 5},
                    Case{"no_chirp", 1024, 0, 0, 15, -5, 60, 210, false, 6},
                    Case{"two_thousand", 2048, 0.07, 0.1, 30, -8, 150, 500, false, 7},
                    Case{"odd_length", 1000, 0.07, -0.1, -25, 6, 70, 230, true, 8},
                    Case{"short_line", 512, 0.06, 0.1, 8, 2, 40, 130, false, 9}),
    [](const auto& spectrometer_case) { return std::string{spectrometer_case.param.name}; });

TEST(MirrorPair, on_either_side_of_zero_delay) {
  for (const bool first_beyond : {false, true}) {
    const Case c{"sides", 1024, 0.068, 0.1, 12, 3, 80, 190, true, 21};
    const sim::Spectrometer s = spectrometer(c);
    const auto found =
        find_mirror_pair(mirror_line(s, c, c.first_bin, first_beyond, 1),
                         mirror_line(s, c, c.second_bin, !first_beyond, 2),
                         first_beyond ? SampleSide::second_mirror : SampleSide::first_mirror);
    ASSERT_TRUE(found) << found.error().message;
    const Errors e = errors(*found, s);
    EXPECT_LE(e.positions_px, 0.05);
    EXPECT_LE(e.dispersion_rad, 0.05);
  }
}

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
      const auto found = find_mirror_pair(first, second, side);
      ASSERT_TRUE(found) << found.error().message;
      Calibration calibration = Calibration::identity(1024);
      calibration.positions = found->positions;
      calibration.dispersion_rad = found->dispersion_rad;
      const auto clean_first = real_mirror(1, true);
      const auto clean_second = real_mirror(2, true);
      const double width_1 =
          measure_axial_psf(clean_first, calibration, found->theta_sign[0]).fwhm_bins;
      const double width_2 =
          measure_axial_psf(clean_second, calibration, found->theta_sign[1]).fwhm_bins;
      fmt::print("  real mirrors, darks {}: {:.2f} and {:.2f} bins at {:.1f} and {:.1f}; residual "
                 "{:.3f} {:.3f} rad, degrees {} {}; bright {}-{} {}-{}\n",
                 darks, width_1, width_2, found->depth_bins[0], found->depth_bins[1],
                 found->fringes[0].residual_rad, found->fringes[1].residual_rad,
                 found->fringes[0].phase_rad.degree(), found->fringes[1].phase_rad.degree(),
                 found->fringes[0].first_bright, found->fringes[0].last_bright,
                 found->fringes[1].first_bright, found->fringes[1].last_bright);
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
