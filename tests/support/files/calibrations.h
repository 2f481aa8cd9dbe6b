// Calibrations of spectrometers that exist on paper only.
#pragma once

#include <cstddef>
#include <vector>

#include "pipeline/calibration/calibration.h"

namespace octascope::tests {

// r(m) bends by `chirp_pixels` in the middle and reaches both ends of the line.
inline pipeline::Calibration chirped_calibration(int samples, double chirp_pixels) {
  auto calibration = pipeline::Calibration::identity(samples);
  for (std::size_t m = 0; m < calibration.positions.size(); ++m) {
    const double u = static_cast<double>(m) / (samples - 1);
    calibration.positions[m] = (samples - 1) * u + 4 * chirp_pixels * u * (1 - u);
  }
  return calibration;
}

// θ(u) = d2·(u − ½)² + d3·(u − ½)³.
inline std::vector<double> dispersion(int samples, double d2, double d3) {
  std::vector<double> theta(static_cast<std::size_t>(samples));
  for (std::size_t m = 0; m < theta.size(); ++m) {
    const double v = static_cast<double>(m) / (samples - 1) - 0.5;
    theta[m] = d2 * v * v + d3 * v * v * v;
  }
  return theta;
}

} // namespace octascope::tests
