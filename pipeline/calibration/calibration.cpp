#include "pipeline/calibration/calibration.h"

#include <cmath>
#include <numeric>
#include <string_view>

#include <fmt/format.h>

namespace octascope::pipeline {

using hal::ErrorCode;

namespace {

template <class Value>
hal::Result<> check_curve(std::string_view name, const std::vector<Value>& curve, int samples,
                          bool may_be_empty) {
  if (curve.empty() && may_be_empty)
    return {};
  if (curve.size() != static_cast<std::size_t>(samples))
    return hal::fail(ErrorCode::bad_data, "calibration: {} has {} values, expected {}", name,
                     curve.size(), samples);
  for (std::size_t m = 0; m < curve.size(); ++m) {
    if (!std::isfinite(curve[m]))
      return hal::fail(ErrorCode::bad_data, "calibration: {} {} is {}, expected a finite number",
                       name, m, curve[m]);
  }
  return {};
}

} // namespace

std::optional<std::string> doubt_about_k_table(const Calibration& calibration,
                                               const std::filesystem::path& file) {
  constexpr double matters_pixels = 0.5;
  if (calibration.k_table != KTable::unsaid)
    return std::nullopt;
  const double distance = distance_the_other_way_round(calibration.positions);
  if (distance < matters_pixels)
    return std::nullopt;
  return fmt::format(
      "{}: [k_linear] table is taken for pixels by wavenumber; if it is wavenumbers by pixel, as "
      "some makers' are, the picture is blurred and positions are off by up to {:.1f} pixels. Say "
      "table_gives = \"pixel\" or \"wavenumber\"; `octascope calibrate --calibration {} --tissue "
      "SPECTRA --shape B,A,N --out NEW` tells which",
      file.string(), distance, file.string());
}

Calibration Calibration::identity(int samples) {
  Calibration calibration;
  calibration.samples = samples;
  calibration.positions.resize(static_cast<std::size_t>(samples));
  std::iota(calibration.positions.begin(), calibration.positions.end(), 0.0);
  calibration.window = make_spectral_window(SpectralWindow::hann, samples);
  return calibration;
}

hal::Result<> Calibration::validate() const {
  if (samples < fewest_samples || samples > most_samples)
    return hal::fail(ErrorCode::invalid_argument, "calibration: samples is {}, expected {} to {}",
                     samples, fewest_samples, most_samples);
  if (zero_padding != 1 && zero_padding != 2)
    return hal::fail(ErrorCode::invalid_argument,
                     "calibration: zero_padding is {}, expected 1 (none) or 2", zero_padding);
  const bool no_background = background_mode != BackgroundMode::file;
  const auto curves =
      check_curve("position", positions, samples, false)
          .and_then([&] { return check_curve("phase", dispersion_rad, samples, true); })
          .and_then([&] { return check_curve("window", window, samples, false); })
          .and_then([&] { return check_curve("background", background, samples, no_background); });
  if (!curves)
    return curves;
  for (std::size_t m = 0; m < positions.size(); ++m) {
    if (positions[m] < 0 || positions[m] > samples - 1)
      return hal::fail(ErrorCode::bad_data, "calibration: position {} is {}, expected 0 to {}", m,
                       positions[m], samples - 1);
  }
  return {};
}

} // namespace octascope::pipeline
