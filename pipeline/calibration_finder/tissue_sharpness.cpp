#include "pipeline/calibration_finder/tissue_sharpness.h"

#include <complex>
#include <functional>
#include <utility>

#include "pipeline/calibration/k_linearisation.h"
#include "pipeline/calibration_finder/axial_psf.h"
#include "pipeline/calibration_finder/fringe.h"
#include "pipeline/calibration_finder/line_transform.h"

namespace octascope::pipeline {

namespace {

constexpr std::size_t most_lines_of_b_scan = 50;

struct Optimum {
  double at = 0;
  double value = 0;
};

// The highest of evenly spaced tries, then golden sections around it.
Optimum maximise(const std::function<double(double)>& measure, double centre, double reach,
                 double step) {
  Optimum best{centre, measure(centre)};
  const auto consider = [&](double x) {
    const double value = measure(x);
    if (value > best.value)
      best = {x, value};
    return value;
  };
  for (double offset = step; offset <= reach; offset += step) {
    consider(centre + offset);
    consider(centre - offset);
  }
  constexpr double golden = 0.6180339887498949;
  constexpr double finest = 0.01; // rad
  double low = best.at - step;
  double high = best.at + step;
  double left = high - golden * (high - low);
  double right = low + golden * (high - low);
  double at_left = consider(left);
  double at_right = consider(right);
  while (high - low > finest) {
    if (at_left > at_right) {
      high = std::exchange(right, left);
      at_right = at_left;
      left = high - golden * (high - low);
      at_left = consider(left);
    } else {
      low = std::exchange(left, right);
      at_left = at_right;
      right = low + golden * (high - low);
      at_right = consider(right);
    }
  }
  return best;
}

// θ in powers of t = m/(N−1): P₂(2t−1) = 1 − 6t + 6t², P₃(2t−1) = −1 + 12t − 30t² + 20t³.
std::vector<double> unit_polynomial(double quadratic, double cubic) {
  return {quadratic - cubic, -6 * quadratic + 12 * cubic, 6 * quadratic - 30 * cubic, 20 * cubic};
}

} // namespace

struct TissueSharpness::State {
  std::size_t samples;
  ResamplingTaps taps;
  std::vector<double> window;
  std::vector<double> lines; // resampled and windowed, one after the other
  LineTransform transform;
};

TissueSharpness::TissueSharpness(const Calibration& calibration)
    : state_(new State{static_cast<std::size_t>(calibration.samples),
                       make_resampling_taps(calibration.positions, calibration.interpolation),
                       calibration.window,
                       {},
                       LineTransform{static_cast<std::size_t>(calibration.samples),
                                     LineTransform::Direction::forward}}) {}
TissueSharpness::~TissueSharpness() = default;

void TissueSharpness::add_b_scan(std::span<const double> counts) {
  const std::size_t n = state_->samples;
  const std::size_t lines = counts.size() / n;
  std::vector<double> mean(n);
  for (std::size_t i = 0; i < lines * n; ++i)
    mean[i % n] += counts[i] / static_cast<double>(lines);
  const std::size_t stride = (lines + most_lines_of_b_scan - 1) / most_lines_of_b_scan;
  std::vector<double> line(n);
  for (std::size_t a = 0; a < lines; a += stride) {
    for (std::size_t p = 0; p < n; ++p)
      line[p] = counts[a * n + p] - mean[p];
    const std::vector<double> x = resample_line(line, state_->taps);
    for (std::size_t m = 0; m < n; ++m)
      state_->lines.push_back(x[m] * state_->window[m]);
  }
}

double TissueSharpness::measure(std::span<const double> theta_rad) {
  const std::size_t n = state_->samples;
  std::vector<std::complex<double>> factor(n, 1.0);
  for (std::size_t m = 0; m < theta_rad.size(); ++m)
    factor[m] = std::polar(1.0, theta_rad[m]);
  double sum = 0;
  double squares = 0;
  const auto values = state_->transform.values();
  for (std::size_t first = 0; first < state_->lines.size(); first += n) {
    for (std::size_t m = 0; m < n; ++m)
      values[m] = state_->lines[first + m] * factor[m];
    state_->transform.run();
    for (std::size_t z = lowest_fringe_bin; z < n / 2; ++z) {
      const double intensity = std::norm(values[z]);
      sum += intensity;
      squares += intensity * intensity;
    }
  }
  return sum > 0 ? squares / (sum * sum) : 0;
}

TissueDispersion find_tissue_dispersion(TissueSharpness& sharpness, int samples,
                                        double widest_rad) {
  TissueDispersion found;
  const auto theta = [&](double quadratic, double cubic) {
    return evaluate_unit_polynomial(unit_polynomial(quadratic, cubic), samples);
  };
  const auto quadratic = [&](double x) { return sharpness.measure(theta(x, found.cubic_rad)); };
  const auto cubic = [&](double x) { return sharpness.measure(theta(found.quadratic_rad, x)); };
  found.sharpness_before = sharpness.measure({});
  found.quadratic_rad = maximise(quadratic, 0, widest_rad, 1).at;
  found.cubic_rad = maximise(cubic, 0, widest_rad / 3, 1).at;
  // Each pulls a little at the other's best place.
  for (int round = 0; round < 3; ++round) {
    found.quadratic_rad = maximise(quadratic, found.quadratic_rad, 2, 0.5).at;
    const Optimum best = maximise(cubic, found.cubic_rad, 2, 0.5);
    found.cubic_rad = best.at;
    found.sharpness_after = best.value;
  }
  found.unit_polynomial_rad = unit_polynomial(found.quadratic_rad, found.cubic_rad);
  found.theta_rad = theta(found.quadratic_rad, found.cubic_rad);
  return found;
}

} // namespace octascope::pipeline
