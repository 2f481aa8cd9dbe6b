#include "pipeline/calibration_finder/spectrum_quality.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "pipeline/calibration_finder/fringe.h"

namespace octascope::pipeline {

namespace {

std::vector<double> mean_of(std::span<const double> lines, std::size_t samples) {
  std::vector<double> mean(samples);
  for (std::size_t i = 0; i < lines.size(); ++i)
    mean[i % samples] += lines[i];
  for (double& value : mean)
    value /= static_cast<double>(lines.size() / samples);
  return mean;
}

constexpr double least_light = 1e-6; // of full scale

// Twice: what once leaves of a source's own curvature is some per cent of its light.
std::vector<double> fringes_of(std::span<const double> line) {
  return remove_slow_part(remove_slow_part(line));
}

double level_of_darkest_hundredth(std::vector<double> values) {
  if (values.empty())
    return 0;
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 100);
  std::ranges::nth_element(values, at);
  return *at;
}

} // namespace

SpectrumQuality judge_spectra(std::span<const double> lines, std::size_t samples,
                              double full_scale) {
  const std::vector<double> mean = mean_of(lines, samples);
  SpectrumQuality quality;
  quality.brightest = *std::ranges::max_element(lines) / full_scale;
  quality.dark_counts = level_of_darkest_hundredth(mean);

  std::vector<double> light = mean; // without fringes, above the dark level
  const std::vector<double> fringes = fringes_of(mean);
  for (std::size_t p = 0; p < samples; ++p)
    light[p] -= fringes[p] + quality.dark_counts;
  const double bright = *std::ranges::max_element(light) / 2;
  double carried = 0;
  double pixels = 0;
  for (const double value : light)
    if (bright > least_light * full_scale && value >= bright) {
      carried += value;
      ++pixels;
    }

  const double count = static_cast<double>(lines.size() / samples);
  for (std::size_t first = 0; first < lines.size(); first += samples) {
    const auto line = lines.subspan(first, samples);
    if (*std::ranges::max_element(line) >= full_scale)
      quality.saturated_share += 1 / count;
    if (!(carried > 0))
      continue; // no light
    const std::vector<double> fast = fringes_of(line);
    double squares = 0;
    for (std::size_t p = 0; p < samples; ++p)
      if (light[p] >= bright)
        squares += fast[p] * fast[p];
    quality.contrast +=
        std::numbers::sqrt2 * std::sqrt(squares / pixels) / (carried / pixels) / count;
  }
  return quality;
}

} // namespace octascope::pipeline
