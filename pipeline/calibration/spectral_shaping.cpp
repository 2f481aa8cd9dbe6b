#include "pipeline/calibration/spectral_shaping.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/calibration/spectral_window.h"

namespace octascope::pipeline {

namespace {

using hal::ErrorCode;

hal::Result<> check(const SourceShaping& shaping, std::size_t samples) {
  if (shaping.source.size() != samples)
    return hal::fail(ErrorCode::bad_data, "source has {} values, expected {}",
                     shaping.source.size(), samples);
  const auto not_finite =
      std::ranges::find_if(shaping.source, [](float value) { return !std::isfinite(value); });
  if (not_finite != shaping.source.end())
    return hal::fail(ErrorCode::bad_data, "source value {} is {}, expected a finite number",
                     not_finite - shaping.source.begin(), *not_finite);
  const auto in_range = [](std::string_view name, double found, double lowest,
                           double highest) -> hal::Result<> {
    if (found >= lowest && found <= highest)
      return {};
    return hal::fail(ErrorCode::invalid_argument, "{} is {}, expected {} to {}", name, found,
                     lowest, highest);
  };
  return in_range("fwhm", shaping.fwhm, SourceShaping::narrowest_fwhm, SourceShaping::widest_fwhm)
      .and_then([&] {
        return in_range("highest_gain", shaping.highest_gain, 1, SourceShaping::most_gain);
      });
}

// As the chain sees it: uniform in k, by the same taps; without light where it is negative.
std::vector<double> source_in_k(const std::vector<float>& source, std::span<const double> positions,
                                Interpolation interpolation) {
  const ResamplingTaps taps = make_resampling_taps(positions, interpolation);
  const auto width = static_cast<std::size_t>(taps.width);
  std::vector<double> light(positions.size());
  for (std::size_t m = 0; m < light.size(); ++m) {
    double sum = width == 0 ? static_cast<double>(source[m]) : 0.0;
    for (std::size_t t = 0; t < width; ++t)
      sum += static_cast<double>(taps.weights[m * width + t]) *
             static_cast<double>(source[static_cast<std::size_t>(taps.first[m]) + t]);
    light[m] = std::max(0.0, sum);
  }
  return light;
}

} // namespace

hal::Result<std::vector<double>> make_shaping_factors(const SourceShaping& shaping,
                                                      std::span<const double> positions,
                                                      Interpolation interpolation) {
  HAL_CHECK(check(shaping, positions.size()));
  const auto light = source_in_k(shaping.source, positions, interpolation);
  const double brightest = *std::ranges::max_element(light);
  if (!(brightest > 0))
    return hal::fail(ErrorCode::bad_data, "source has no light: its highest value is 0 or less, "
                                          "expected a spectrum with its dark counts taken off");
  double sum = 0;
  double moment = 0;
  for (std::size_t m = 0; m < light.size(); ++m) {
    sum += light[m];
    moment += light[m] * static_cast<double>(m);
  }
  const double centre = moment / sum;
  const double fwhm_samples = shaping.fwhm * static_cast<double>(light.size());

  const auto hann = make_spectral_window(SpectralWindow::hann, static_cast<int>(light.size()));
  std::vector<double> factors(light.size());
  double brightness = 0;
  double brightness_with_hann = 0;
  for (std::size_t m = 0; m < light.size(); ++m) {
    const double x = (static_cast<double>(m) - centre) / fwhm_samples;
    const double target = std::exp(-4 * std::numbers::ln2 * x * x);
    factors[m] = target / std::max(light[m], brightest / shaping.highest_gain);
    brightness += light[m] * factors[m];
    brightness_with_hann += light[m] * hann[m];
  }
  if (!(brightness > 0 && brightness_with_hann > 0))
    return hal::fail(ErrorCode::bad_data, "source has light at the line's ends alone, expected a "
                                          "spectrum with its light in the middle");
  for (double& factor : factors)
    factor *= brightness_with_hann / brightness;
  return factors;
}

} // namespace octascope::pipeline
