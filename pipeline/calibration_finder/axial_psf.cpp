#include "pipeline/calibration_finder/axial_psf.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "pipeline/calibration_finder/fringe.h"
#include "pipeline/calibration_finder/line_transform.h"

namespace octascope::pipeline {

namespace {

// Where |Y| crosses `half` between i and i + 1.
double crossing(const std::vector<double>& magnitude, std::size_t i, double half) {
  const double step = magnitude[i + 1] - magnitude[i];
  return static_cast<double>(i) + (step == 0 ? 0 : (half - magnitude[i]) / step);
}

} // namespace

std::vector<double> resample_line(std::span<const double> line, const ResamplingTaps& taps) {
  std::vector<double> x(line.begin(), line.end());
  if (taps.width == 0)
    return x;
  const auto width = static_cast<std::size_t>(taps.width);
  for (std::size_t m = 0; m < x.size(); ++m) {
    x[m] = 0;
    for (std::size_t t = 0; t < width; ++t)
      x[m] += static_cast<double>(taps.weights[m * width + t]) *
              line[static_cast<std::size_t>(taps.first[m]) + t];
  }
  return x;
}

AxialPsf measure_axial_psf(std::span<const double> line, const Calibration& calibration,
                           double theta_sign) {
  const std::size_t n = line.size();
  const std::vector<double> x =
      resample_line(line, make_resampling_taps(calibration.positions, calibration.interpolation));
  LineTransform transform{n * psf_steps_per_bin, LineTransform::Direction::forward};
  std::fill(transform.values().begin(), transform.values().end(), std::complex<double>{});
  for (std::size_t m = 0; m < n; ++m) {
    const double theta = calibration.dispersion_rad.empty() ? 0 : calibration.dispersion_rad[m];
    transform.values()[m] = std::polar(1.0, theta_sign * theta) * x[m] * calibration.window[m];
  }
  transform.run();

  AxialPsf psf;
  psf.magnitude.resize(n / 2 * psf_steps_per_bin);
  std::transform(transform.values().begin(),
                 transform.values().begin() + static_cast<std::ptrdiff_t>(psf.magnitude.size()),
                 psf.magnitude.begin(),
                 [&](auto bin) { return std::abs(bin) / static_cast<double>(n); });
  const auto first = psf.magnitude.begin() + lowest_fringe_bin * psf_steps_per_bin;
  const auto peak = static_cast<std::size_t>(std::max_element(first, psf.magnitude.end()) -
                                             psf.magnitude.begin());
  const double half = psf.magnitude[peak] / 2;
  // Lobes of a chirped peak count, remains of the background do not.
  std::size_t left = std::max<std::size_t>(lowest_fringe_bin * psf_steps_per_bin, peak / 2);
  while (left < peak && psf.magnitude[left] < half)
    ++left;
  std::size_t right = std::min(psf.magnitude.size() - 1, peak + peak / 2);
  while (right > peak && psf.magnitude[right] < half)
    --right;
  const double from = left > 0 ? crossing(psf.magnitude, left - 1, half) : 0;
  const double to = right + 1 < psf.magnitude.size() ? crossing(psf.magnitude, right, half)
                                                     : static_cast<double>(right);
  psf.fwhm_bins = (to - from) / psf_steps_per_bin;
  psf.level_db = 20 * std::log10(std::max(psf.magnitude[peak], 1e-30));
  double offset = 0; // of the parabola through the peak and its neighbours
  if (peak > 0 && peak + 1 < psf.magnitude.size()) {
    const double before = psf.magnitude[peak - 1];
    const double after = psf.magnitude[peak + 1];
    const double bend = before - 2 * psf.magnitude[peak] + after;
    offset = bend == 0 ? 0 : 0.5 * (before - after) / bend;
  }
  psf.peak_bin = (static_cast<double>(peak) + offset) / psf_steps_per_bin;
  return psf;
}

} // namespace octascope::pipeline
