// Dispersion from sharpness alone: of simulated tissue whose dispersion is known, and of the real.
#include <cmath>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pipeline/calibration_finder/tissue_sharpness.h"
#include "pipeline/reconstruction/spectra_file.h"
#include "sim/spectrometer/spectrometer.h"
#include "tests/support/files/test_data.h"
#include "tests/support/files/tissue_calibration.h"

namespace octascope::pipeline {
namespace {

// Lines with a surface and scatterers below it, at random places with random phases.
std::vector<double> tissue(const sim::Spectrometer& s, int lines, std::uint64_t seed) {
  std::mt19937_64 generator{seed};
  std::uniform_real_distribution<double> unit;
  std::normal_distribution<double> normal;
  std::vector<double> counts;
  for (int a = 0; a < lines; ++a) {
    std::vector<sim::Reflector> reflectors;
    for (int i = 0; i < 12; ++i)
      reflectors.push_back(
          {60 + 8.0 * i + 6 * unit(generator), 60 * std::exp(-0.2 * i), 6.283 * unit(generator)});
    for (const double mean : s.mean_counts(reflectors))
      counts.push_back(std::round(mean + 6 * normal(generator)));
  }
  return counts;
}

TEST(TissueSharpness, finds_dispersion_and_its_sign) {
  for (const double quadratic : {25.0, -18.0, 0.0}) {
    sim::SpectrometerConfig config;
    config.dispersion_quadratic_rad = quadratic;
    config.dispersion_cubic_rad = quadratic / 5;
    const auto s = *sim::Spectrometer::make(config);
    Calibration calibration = Calibration::identity(s.samples());
    calibration.positions = s.true_k_positions();
    TissueSharpness sharpness{calibration};
    sharpness.add_b_scan(tissue(s, 50, 7));
    const auto found = find_tissue_dispersion(sharpness, s.samples());
    fmt::print("  quadratic {:.2f} rad (true {}), cubic {:.2f} rad (true {}), sharpness {:.3g} -> "
               "{:.3g}\n",
               found.quadratic_rad, quadratic, found.cubic_rad, quadratic / 5,
               found.sharpness_before, found.sharpness_after);
    EXPECT_NEAR(found.quadratic_rad, quadratic, 0.5);
    EXPECT_NEAR(found.cubic_rad, quadratic / 5, 0.7);
    EXPECT_GE(found.sharpness_after, found.sharpness_before);
    EXPECT_GE(found.sharpness_after, 0.995 * sharpness.measure(s.true_dispersion_rad()));
    // The polynomial is the curve.
    double t_power = 1;
    double value = 0;
    for (const double d : found.unit_polynomial_rad) {
      value += d * t_power;
      t_power *= 300.0 / (s.samples() - 1);
    }
    EXPECT_NEAR(value, found.theta_rad[300], 1e-9);
  }
}

TEST(TissueSharpness, real_tissue_is_as_sharp_as_with_the_supplied_curves) {
  OCTASCOPE_REQUIRE_TEST_DATA("sd-oct-tissue/spectra_u16_100x100x1024.raw");
  const auto supplied = Calibration::load(tests::TissueCalibration{}.file(), 1024);
  const auto spectra =
      SpectraFile::open(tests::test_data_folder() / "sd-oct-tissue/spectra_u16_100x100x1024.raw",
                        {100, 100, 1024}, hal::SampleType::u16);
  ASSERT_TRUE(supplied && spectra);
  TissueSharpness sharpness{*supplied};
  for (const int b : {25, 50, 75}) {
    const auto bytes = spectra->b_scan(b);
    const std::span raw{reinterpret_cast<const std::uint16_t*>(bytes.data()), bytes.size() / 2};
    sharpness.add_b_scan(std::vector<double>(raw.begin(), raw.end()));
  }
  const auto found = find_tissue_dispersion(sharpness, 1024);
  const double with_supplied = sharpness.measure(supplied->dispersion_rad);
  std::vector<double> other_sign = supplied->dispersion_rad;
  for (double& theta : other_sign)
    theta = -theta;
  fmt::print(
      "  sharpness {:.4g} without, {:.4g} supplied, {:.4g} supplied mirrored, {:.4g} found\n",
      found.sharpness_before, with_supplied, sharpness.measure(other_sign), found.sharpness_after);
  EXPECT_GE(found.sharpness_after, with_supplied);
  double along = 0; // the same sign as the supplied curve
  for (std::size_t m = 100; m < 900; ++m)
    along += found.theta_rad[m] * supplied->dispersion_rad[m];
  EXPECT_GT(along, 0);
}

} // namespace
} // namespace octascope::pipeline
