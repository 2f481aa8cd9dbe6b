#include <cmath>

#include <gtest/gtest.h>

#include "pipeline/spectral_window.h"

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

} // namespace
} // namespace octascope::pipeline
