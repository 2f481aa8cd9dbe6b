// The real mirrors: how sharp the supplied curves make them.
#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "pipeline/calibration/calibration.h"
#include "pipeline/files/text_curve.h"
#include "pipeline/reconstruction/reconstructor.h"
#include "tests/support/files/test_data.h"
#include "tests/support/files/tissue_calibration.h"
#include "tests/support/spectra/reference_chain.h"

namespace octascope::pipeline {
namespace {

constexpr int samples = 1024;
constexpr std::size_t padded = 16384;

std::vector<float> spectrum(const std::string& name) {
  const auto values = read_float_curve(
      tests::test_data_folder() / "sd-oct-tissue" / (name + "_f32_1024.raw"), samples);
  return values ? *values : std::vector<float>{};
}

// Mirror without the light of either arm, in counts.
std::vector<float> interferogram(int mirror) {
  auto line = spectrum(fmt::format("mirror{}", mirror));
  const auto none = spectrum("dark_not");
  const auto sample = spectrum(fmt::format("dark_sample{}", mirror));
  const auto reference = spectrum("dark_ref");
  for (std::size_t p = 0; p < line.size(); ++p)
    line[p] = 6209.113F * (line[p] + none[p] - sample[p] - reference[p]);
  return line;
}

// Full width at half maximum in bins of the 1024-point transform, of the production chain's taps,
// window and phases followed by a zero-padded transform.
double fwhm_bins(const std::vector<float>& line, const Calibration& calibration) {
  const auto taps = make_resampling_taps(calibration.positions, calibration.interpolation);
  std::vector<std::complex<double>> shaped(padded);
  for (std::size_t m = 0; m < samples; ++m) {
    double x = 0;
    for (int t = 0; t < taps.width; ++t)
      x += static_cast<double>(
          taps.weights[m * static_cast<std::size_t>(taps.width) + static_cast<std::size_t>(t)] *
          line[static_cast<std::size_t>(taps.first[m] + t)]);
    const double theta = calibration.dispersion_rad.empty() ? 0 : calibration.dispersion_rad[m];
    shaped[m] = std::polar(x * calibration.window[m], theta);
  }
  const auto bins = tests::reference_transform(std::move(shaped));
  std::vector<double> magnitude(padded / 2);
  std::transform(bins.begin(), bins.begin() + padded / 2, magnitude.begin(),
                 [](auto bin) { return std::abs(bin); });
  constexpr std::ptrdiff_t first = 10 * padded / samples; // behind what is left of the background
  const auto peak = std::max_element(magnitude.begin() + first, magnitude.end());
  const double half = *peak / 2;
  auto left = peak;
  while (*left > half)
    --left;
  auto right = peak;
  while (*right > half)
    ++right;
  const double from =
      static_cast<double>(left - magnitude.begin()) + (half - *left) / (*(left + 1) - *left);
  const double to =
      static_cast<double>(right - magnitude.begin()) - (half - *right) / (*(right - 1) - *right);
  return (to - from) * samples / padded;
}

TEST(AxialPsf, both_mirrors_are_sharp_with_the_supplied_curves) {
  OCTASCOPE_REQUIRE_TEST_DATA("sd-oct-tissue/mirror1_f32_1024.raw");
  const auto loaded = Calibration::load(tests::TissueCalibration{}.file(), samples);
  ASSERT_TRUE(loaded) << loaded.error().message;
  for (const int mirror : {1, 2}) {
    const auto line = interferogram(mirror);
    Calibration linear_only = *loaded;
    linear_only.dispersion_rad.clear();
    // The mirrors lie on either side of zero delay: the phase of the first is mirrored.
    Calibration both = *loaded;
    for (double& theta : both.dispersion_rad)
      theta *= mirror == 1 ? -1 : 1;
    const double k_linear = fwhm_bins(line, linear_only);
    const double compensated = fwhm_bins(line, both);
    fmt::print("  mirror {}: {:.2f} bins k-linear, {:.2f} with dispersion\n", mirror, k_linear,
               compensated);
    EXPECT_LE(k_linear, 2.5);
    EXPECT_LE(compensated, 2.5);
    EXPECT_LT(compensated, k_linear);
  }
}

} // namespace
} // namespace octascope::pipeline
