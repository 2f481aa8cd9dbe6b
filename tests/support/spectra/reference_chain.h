// The reconstruction once more, independent of pipeline/: double precision, the library's
// functions, formulas as they stand in books, no tables. Slow and plain, the oracle of the fast
// paths.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <numbers>
#include <span>
#include <vector>

#include <fftw3.h>

#include "pipeline/calibration/calibration.h"

namespace octascope::tests {

// Σ in[m]·exp(−2πi·km/N), k = 0 … N−1.
inline std::vector<std::complex<double>> reference_transform(std::vector<std::complex<double>> in) {
  std::vector<std::complex<double>> out(in.size());
  const fftw_plan plan =
      fftw_plan_dft_1d(static_cast<int>(in.size()), reinterpret_cast<fftw_complex*>(in.data()),
                       reinterpret_cast<fftw_complex*>(out.data()), FFTW_FORWARD, FFTW_ESTIMATE);
  fftw_execute(plan);
  fftw_destroy_plan(plan);
  return out;
}

// The line continues with its first and last sample beyond its ends.
inline double reference_sample(std::span<const double> line, std::ptrdiff_t p) {
  return line[static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(p, 0, static_cast<std::ptrdiff_t>(line.size()) - 1))];
}

inline double reference_interpolate(std::span<const double> line, double position,
                                    pipeline::Interpolation kind) {
  const double whole = std::floor(position);
  const double f = position - whole;
  const auto p = static_cast<std::ptrdiff_t>(whole);
  const auto at = [&](std::ptrdiff_t offset) { return reference_sample(line, p + offset); };
  if (kind == pipeline::Interpolation::linear)
    return at(0) + f * (at(1) - at(0));
  if (kind == pipeline::Interpolation::cubic) { // Catmull-Rom as a Hermite spline
    const double slope0 = (at(1) - at(-1)) / 2;
    const double slope1 = (at(2) - at(0)) / 2;
    const double f2 = f * f;
    const double f3 = f2 * f;
    return (2 * f3 - 3 * f2 + 1) * at(0) + (f3 - 2 * f2 + f) * slope0 + (-2 * f3 + 3 * f2) * at(1) +
           (f3 - f2) * slope1;
  }
  double sum = 0;
  double weights = 0;
  for (std::ptrdiff_t t = -3; t <= 4; ++t) {
    const double x = static_cast<double>(t) - f;
    if (std::abs(x) >= 4)
      continue;
    const double sinc = x == 0 ? 1 : std::sin(std::numbers::pi * x) / (std::numbers::pi * x);
    const double weight = sinc * std::cyl_bessel_i(0.0, 4 * std::sqrt(1 - x * x / 16));
    sum += weight * at(t);
    weights += weight;
  }
  return sum / weights;
}

// One line without its background → N/2 complex bins (N with zero-padding) of Y = FFT(y).
inline std::vector<std::complex<double>> reference_bins(std::span<const double> line,
                                                        const pipeline::Calibration& calibration) {
  const std::size_t n = line.size();
  std::vector<std::complex<double>> shaped(n);
  for (std::size_t m = 0; m < n; ++m) {
    const double theta = calibration.dispersion_rad.empty() ? 0 : calibration.dispersion_rad[m];
    shaped[m] = std::polar(1.0, theta) * calibration.window[m] *
                reference_interpolate(line, calibration.positions[m], calibration.interpolation);
  }
  shaped.resize(n * static_cast<std::size_t>(calibration.zero_padding));
  auto bins = reference_transform(std::move(shaped));
  bins.resize(bins.size() / 2);
  for (auto& bin : bins)
    bin /= static_cast<double>(n);
  return bins;
}

// The first B-scan, `lines` lines of counts (shifted already) → bins [a][z]. A running background
// is the mean there.
inline std::vector<std::complex<double>>
reference_b_scan_bins(std::span<const double> counts, int lines,
                      const pipeline::Calibration& calibration) {
  const auto n = static_cast<std::size_t>(calibration.samples);
  std::vector<double> background(n, 0.0);
  if (calibration.background_mode == pipeline::BackgroundMode::file)
    background.assign(calibration.background.begin(), calibration.background.end());
  if (calibration.background_mode == pipeline::BackgroundMode::mean ||
      calibration.background_mode == pipeline::BackgroundMode::running) {
    for (std::size_t i = 0; i < counts.size(); ++i)
      background[i % n] += counts[i] / lines;
  }
  std::vector<std::complex<double>> bins;
  for (std::size_t a = 0; a < static_cast<std::size_t>(lines); ++a) {
    std::vector<double> line(n);
    for (std::size_t p = 0; p < n; ++p)
      line[p] = counts[a * n + p] - background[p];
    const auto profile = reference_bins(line, calibration);
    bins.insert(bins.end(), profile.begin(), profile.end());
  }
  return bins;
}

// Not clamped.
inline std::vector<double> reference_levels_db(std::span<const std::complex<double>> bins) {
  std::vector<double> levels;
  for (const auto& bin : bins)
    levels.push_back(20 * std::log10(std::abs(bin)));
  return levels;
}

// The same as levels in decibels.
inline std::vector<double> reference_b_scan_db(std::span<const double> counts, int lines,
                                               const pipeline::Calibration& calibration) {
  return reference_levels_db(reference_b_scan_bins(counts, lines, calibration));
}

// The 8-bit count of a level, by its definition: half a decibel a count from −40 dB.
inline int reference_count(double db) {
  return static_cast<int>(std::lround(std::clamp((db + 40) / 0.5, 0.0, 255.0)));
}

} // namespace octascope::tests
