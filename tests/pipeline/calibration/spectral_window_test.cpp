#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/calibration/spectral_window.h"

namespace octascope::pipeline {
namespace {

constexpr SpectralWindow all[] = {SpectralWindow::hann,     SpectralWindow::hamming,
                                  SpectralWindow::blackman, SpectralWindow::gaussian,
                                  SpectralWindow::tukey,    SpectralWindow::flat};

TEST(SpectralWindow, is_symmetric_within_0_and_1_and_1_in_the_middle) {
  for (const auto kind : all) {
    for (const int samples : {17, 256}) {
      const auto w = make_spectral_window(kind, samples);
      ASSERT_EQ(w.size(), static_cast<std::size_t>(samples));
      for (std::size_t m = 0; m < w.size(); ++m) {
        EXPECT_NEAR(w[m], w[w.size() - 1 - m], 1e-12);
        EXPECT_GE(w[m], 0);
        EXPECT_LE(w[m], 1);
      }
      EXPECT_NEAR(w[w.size() / 2], 1, samples == 17 ? 1e-12 : 1e-3);
    }
  }
}

TEST(SpectralWindow, ends_are_as_in_the_books) {
  EXPECT_NEAR(make_spectral_window(SpectralWindow::hann, 65)[0], 0, 1e-12);
  EXPECT_NEAR(make_spectral_window(SpectralWindow::hann, 65)[16], 0.5, 1e-12);
  EXPECT_NEAR(make_spectral_window(SpectralWindow::hamming, 65)[0], 0.08, 1e-12);
  EXPECT_NEAR(make_spectral_window(SpectralWindow::blackman, 65)[16], 0.34, 1e-12);
  EXPECT_NEAR(make_spectral_window(SpectralWindow::gaussian, 65)[0], std::exp(-0.5 / 0.16), 1e-12);
  EXPECT_NEAR(make_spectral_window(SpectralWindow::tukey, 65)[8], 0.5, 1e-12);
  EXPECT_EQ(make_spectral_window(SpectralWindow::tukey, 65)[16], 1);
  EXPECT_EQ(make_spectral_window(SpectralWindow::flat, 65)[0], 1);
}

// Σ w[m]·exp(−2πi·x·m/N) of the periodic window, which the first N of N+1 symmetric samples are.
double response(const std::vector<double>& window, double x) {
  std::complex<double> sum = 0;
  const auto n = static_cast<double>(window.size() - 1);
  for (std::size_t m = 0; m + 1 < window.size(); ++m)
    sum += window[m] * std::polar(1.0, -2 * std::numbers::pi * x * static_cast<double>(m) / n);
  return std::abs(sum);
}

TEST(SpectralWindow, cosine_windows_have_the_transform_of_their_terms) {
  // a0 − a1·cos + a2·cos2 has at x = 0, 1, 2, 3 bins N·(a0, a1/2, a2/2, 0), and nothing between.
  const auto check = [](SpectralWindow kind, double a0, double a1, double a2) {
    const auto window = make_spectral_window(kind, 129);
    EXPECT_NEAR(response(window, 0), 128 * a0, 1e-9);
    EXPECT_NEAR(response(window, 1), 64 * a1, 1e-9);
    EXPECT_NEAR(response(window, 2), 64 * a2, 1e-9);
    for (const int x : {3, 4, 20, 64})
      EXPECT_NEAR(response(window, x), 0, 1e-9);
  };
  check(SpectralWindow::flat, 1, 0, 0);
  check(SpectralWindow::hann, 0.5, 0.5, 0);
  check(SpectralWindow::hamming, 0.54, 0.46, 0);
  check(SpectralWindow::blackman, 0.42, 0.5, 0.08);
}

TEST(SpectralWindow, gaussian_and_tukey_are_their_closed_forms) {
  for (const int samples : {33, 200}) {
    const auto gaussian = make_spectral_window(SpectralWindow::gaussian, samples);
    const auto tukey = make_spectral_window(SpectralWindow::tukey, samples);
    for (int m = 0; m < samples; ++m) {
      const double half = (samples - 1) / 2.0;
      const double x = std::abs(m - half) / half; // 0 in the middle, 1 at the ends
      EXPECT_NEAR(gaussian[static_cast<std::size_t>(m)], std::exp(-x * x / (2 * 0.4 * 0.4)), 1e-12);
      const double taper = std::pow(std::cos(std::numbers::pi / 2 * (x - 0.5) / 0.5), 2);
      EXPECT_NEAR(tukey[static_cast<std::size_t>(m)], x <= 0.5 ? 1 : taper, 1e-12);
    }
  }
}

TEST(SpectralWindow, side_lobes_are_as_in_the_books) {
  // F. J. Harris, Proceedings of the IEEE 66 (1978) 51, table 1.
  const auto highest_db = [](SpectralWindow kind) {
    const auto window = make_spectral_window(kind, 257);
    double last = response(window, 0);
    double x = 0.01;
    for (double now = response(window, x); now < last; now = response(window, x)) {
      last = now; // down the main lobe
      x += 0.01;
    }
    double highest = 0;
    for (; x < 128; x += 0.01)
      highest = std::max(highest, response(window, x));
    return 20 * std::log10(highest / response(window, 0));
  };
  EXPECT_NEAR(highest_db(SpectralWindow::flat), -13.3, 0.2);
  EXPECT_NEAR(highest_db(SpectralWindow::hann), -31.5, 0.2);
  EXPECT_NEAR(highest_db(SpectralWindow::hamming), -42.7, 0.5);
  EXPECT_NEAR(highest_db(SpectralWindow::blackman), -58.1, 0.3);
  EXPECT_NEAR(highest_db(SpectralWindow::gaussian), -42, 2);  // alpha = 2.5
  EXPECT_NEAR(highest_db(SpectralWindow::tukey), -15.1, 0.3); // alpha = 0.5
}

} // namespace
} // namespace octascope::pipeline
