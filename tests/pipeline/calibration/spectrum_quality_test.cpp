#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/calibration_finder/spectrum_quality.h"

namespace octascope::pipeline {
namespace {

constexpr std::size_t samples = 1024;
constexpr double full_scale = 4095;
constexpr double dark = 100;
constexpr double light = 2000;

// A broad source with a fringe of that contrast, each line with another phase.
std::vector<double> fringes(double contrast, std::size_t lines) {
  std::vector<double> all;
  for (std::size_t line = 0; line < lines; ++line)
    for (std::size_t p = 0; p < samples; ++p) {
      const double t = static_cast<double>(p) / samples - 0.5;
      const double envelope = light * std::exp(-t * t / (2 * 0.15 * 0.15));
      all.push_back(dark + envelope * (1 + contrast * std::cos(2 * std::numbers::pi * 120 * t +
                                                               static_cast<double>(line))));
    }
  return all;
}

TEST(SpectrumQuality, measures_the_contrast_that_was_put_in) {
  for (const double contrast : {0.05, 0.2, 0.6}) {
    const SpectrumQuality found = judge_spectra(fringes(contrast, 6), samples, full_scale);
    EXPECT_NEAR(found.contrast, contrast, 0.1 * contrast);
    EXPECT_EQ(found.saturated_share, 0);
  }
}

TEST(SpectrumQuality, tells_dark_level_and_brightness) {
  const SpectrumQuality found = judge_spectra(fringes(0, 3), samples, full_scale);
  EXPECT_NEAR(found.dark_counts, dark, 15);
  EXPECT_NEAR(found.brightest, (dark + light) / full_scale, 1e-6);
  EXPECT_LT(found.contrast, 0.02);
}

TEST(SpectrumQuality, counts_lines_that_reach_full_scale) {
  std::vector<double> lines = fringes(0.1, 4);
  lines[samples + 500] = full_scale;
  EXPECT_DOUBLE_EQ(judge_spectra(lines, samples, full_scale).saturated_share, 0.25);
}

TEST(SpectrumQuality, has_no_contrast_without_light) {
  const std::vector<double> nothing(2 * samples, 7.0);
  const SpectrumQuality found = judge_spectra(nothing, samples, full_scale);
  EXPECT_EQ(found.contrast, 0);
  EXPECT_EQ(found.dark_counts, 7);
}

} // namespace
} // namespace octascope::pipeline
