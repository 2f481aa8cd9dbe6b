// One reflector on a spectrometer whose chirp and dispersion are known, and what theory says of its
// peak. Independent of pipeline/ and of the simulated spectrometer: closed forms in double
// precision.
//
// A Hann window of N samples, sin²(πm/(N−1)), has the mean (N−1)/(2N); a reflector of amplitude a
// between two bins, δ bins from the nearer, has there the level a/2 · mean · h(δ) with
// h(δ) = sinc(δ)/(1 − δ²), and at the neighbours h(δ ± 1): from which
// δ = 2·(above − below)/(below + 2·here + above).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include "pipeline/calibration/calibration.h"

namespace octascope::tests {

// offset + amplitude·cos(2π·d·m(p)/N + φ − θ(m(p))), with m(p) and θ of the calibration's curves as
// they continue between its samples: a table is interpolated by a cubic through four values.
class ReflectorLine {
public:
  explicit ReflectorLine(const pipeline::Calibration& calibration)
      : positions_(calibration.positions), theta_(calibration.dispersion_rad) {
    for (std::size_t p = 0; p < positions_.size(); ++p)
      k_of_pixel_.push_back(k_of(static_cast<double>(p)));
  }

  std::vector<double> counts(double depth_bin, double phase_rad, double amplitude,
                             double offset) const {
    const auto n = static_cast<double>(k_of_pixel_.size());
    std::vector<double> line;
    for (const double m : k_of_pixel_)
      line.push_back(offset + amplitude * std::cos(2 * std::numbers::pi * depth_bin * m / n +
                                                   phase_rad - at(theta_, m)));
    return line;
  }

private:
  // Lagrange's cubic through the four samples around m.
  static double at(const std::vector<double>& values, double m) {
    if (values.empty())
      return 0;
    const auto last = static_cast<double>(values.size()) - 4;
    const double first = std::clamp(std::floor(m) - 1, 0.0, last);
    double sum = 0;
    for (int i = 0; i < 4; ++i) {
      double weight = 1;
      for (int j = 0; j < 4; ++j) {
        if (j != i)
          weight *= (m - first - j) / (i - j);
      }
      sum += weight * values[static_cast<std::size_t>(first) + static_cast<std::size_t>(i)];
    }
    return sum;
  }
  double k_of(double pixel) const { // r rises: bisection
    double below = 0;
    double above = static_cast<double>(positions_.size()) - 1;
    for (int i = 0; i < 60; ++i) {
      const double middle = (below + above) / 2;
      (at(positions_, middle) < pixel ? below : above) = middle;
    }
    return (below + above) / 2;
  }

  std::vector<double> positions_;
  std::vector<double> theta_;
  std::vector<double> k_of_pixel_;
};

struct ReflectorPeak {
  double depth_bin = 0;
  double level_db = 0;    // of a reflector on a bin: without the loss between two bins
  double artefact_db = 0; // highest level elsewhere, relative to the peak
};

// The level of a reflector of amplitude a on a bin, through a Hann window over `samples`.
inline double hann_level_db(double amplitude, int samples) {
  return 20 * std::log10(amplitude / 2 * (samples - 1) / (2.0 * samples));
}

// `levels_db` are the N/2 levels of one A-scan that was reconstructed with a Hann window; the peak
// is the highest within `reach` bins of `near_bin`.
inline ReflectorPeak measure_reflector(std::span<const float> levels_db, double near_bin,
                                       int reach = 4) {
  const auto bin = [&](int z) {
    return static_cast<double>(levels_db[static_cast<std::size_t>(z)]);
  };
  const int depths = static_cast<int>(levels_db.size());
  int peak = std::clamp(static_cast<int>(std::lround(near_bin)), 1, depths - 2);
  const int from = std::max(1, peak - reach);
  const int to = std::min(depths - 2, peak + reach);
  for (int z = from; z <= to; ++z)
    peak = bin(z) > bin(peak) ? z : peak;
  const auto magnitude = [&](int z) { return std::pow(10, (bin(z) - bin(peak)) / 20); };
  const double below = magnitude(peak - 1);
  const double above = magnitude(peak + 1);
  const double delta = 2 * (above - below) / (below + 2 + above);
  const double x = std::numbers::pi * delta;
  const double between = (std::abs(delta) < 1e-6 ? 1 : std::sin(x) / x) / (1 - delta * delta);
  ReflectorPeak found{peak + delta, bin(peak) - 20 * std::log10(between), -999};
  constexpr int main_lobe = 20; // and the side lobes of a Hann window above −88 dB
  for (int z = 2; z < depths; ++z) {
    if (std::abs(z - peak) > main_lobe)
      found.artefact_db = std::max(found.artefact_db, bin(z) - found.level_db);
  }
  return found;
}

} // namespace octascope::tests
