#include "pipeline/calibration/spectral_window.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace octascope::pipeline {

namespace {

constexpr double gaussian_sigma = 0.4;
constexpr double tukey_taper = 0.5; // of the width, both ends together

// u runs from 0 to 1 over the line.
double window_at(SpectralWindow kind, double u) {
  const double phase = 2 * std::numbers::pi * u;
  switch (kind) {
  case SpectralWindow::hann: return 0.5 - 0.5 * std::cos(phase);
  case SpectralWindow::hamming: return 0.54 - 0.46 * std::cos(phase);
  // Its ends are 0 but for rounding, which must not make them negative.
  case SpectralWindow::blackman:
    return std::max(0.0, 0.42 - 0.5 * std::cos(phase) + 0.08 * std::cos(2 * phase));
  case SpectralWindow::gaussian: {
    const double x = (2 * u - 1) / gaussian_sigma;
    return std::exp(-0.5 * x * x);
  }
  case SpectralWindow::tukey: {
    const double from_end = std::min(u, 1 - u);
    if (from_end >= tukey_taper / 2)
      return 1;
    return 0.5 - 0.5 * std::cos(2 * std::numbers::pi * from_end / tukey_taper);
  }
  case SpectralWindow::flat: return 1;
  }
  return 1;
}

} // namespace

std::vector<double> make_spectral_window(SpectralWindow kind, int samples) {
  std::vector<double> window(static_cast<std::size_t>(samples));
  for (std::size_t m = 0; m < window.size(); ++m)
    window[m] = window_at(kind, static_cast<double>(m) / (samples - 1));
  return window;
}

} // namespace octascope::pipeline
