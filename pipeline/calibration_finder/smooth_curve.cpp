#include "pipeline/calibration_finder/smooth_curve.h"

#include <algorithm>
#include <cmath>

namespace octascope::pipeline {

namespace {

// P_0(u) … P_degree(u) by Bonnet's recursion.
void legendre(double u, std::span<double> values) {
  values[0] = 1;
  if (values.size() > 1)
    values[1] = u;
  for (std::size_t n = 2; n < values.size(); ++n) {
    const auto k = static_cast<double>(n);
    values[n] = ((2 * k - 1) * u * values[n - 1] - (k - 1) * values[n - 2]) / k;
  }
}

// Solves the symmetric positive definite system in place (Cholesky); the first `size` rows and
// columns of `matrix`, whose rows are `stride` long.
std::vector<double> solve(std::vector<double> matrix, std::vector<double> right, std::size_t size,
                          std::size_t stride) {
  const auto at = [&](std::size_t row, std::size_t column) -> double& {
    return matrix[row * stride + column];
  };
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = at(i, j);
      for (std::size_t k = 0; k < j; ++k)
        sum -= at(i, k) * at(j, k);
      at(i, j) = i == j ? std::sqrt(std::max(sum, 1e-13 * at(i, i) + 1e-300)) : sum / at(j, j);
    }
    double sum = right[i];
    for (std::size_t k = 0; k < i; ++k)
      sum -= at(i, k) * right[k];
    right[i] = sum / at(i, i);
  }
  for (std::size_t i = size; i-- > 0;) {
    double sum = right[i];
    for (std::size_t k = i + 1; k < size; ++k)
      sum -= at(k, i) * right[k];
    right[i] = sum / at(i, i);
  }
  right.resize(size);
  return right;
}

} // namespace

SmoothCurve::SmoothCurve(double first, double last, std::vector<double> coefficients)
    : centre_((first + last) / 2), half_width_((last - first) / 2),
      coefficients_(std::move(coefficients)), low_(end(-1)), high_(end(1)) {}

SmoothCurve::End SmoothCurve::end(double sign) const {
  // Slope and curvature by least squares from values at distances v from the end, with no constant:
  // value(v) − value(0) = slope·v + curvature·v²/2.
  constexpr double reach = 0.4; // of u, which is a fifth of the range
  constexpr int points = 16;
  const double value = polynomial(sign);
  double s2 = 0;
  double s3 = 0;
  double s4 = 0;
  double r1 = 0;
  double r2 = 0;
  for (int i = 1; i <= points; ++i) {
    const double v = -sign * reach * i / points;
    const double y = polynomial(sign + v) - value;
    s2 += v * v;
    s3 += v * v * v / 2;
    s4 += v * v * v * v / 4;
    r1 += v * y;
    r2 += v * v * y / 2;
  }
  const double determinant = s2 * s4 - s3 * s3;
  return {value, (r1 * s4 - r2 * s3) / determinant, (r2 * s2 - r1 * s3) / determinant};
}

double SmoothCurve::polynomial(double u) const {
  double sum = 0;
  double before = 0;
  double here = 1;
  for (std::size_t n = 0; n < coefficients_.size(); ++n) {
    sum += coefficients_[n] * here;
    const auto k = static_cast<double>(n + 1);
    const double next = ((2 * k - 1) * u * here - (k - 1) * before) / k;
    before = here;
    here = next;
  }
  return sum;
}

double SmoothCurve::at(double x) const {
  const double u = (x - centre_) / half_width_;
  if (std::abs(u) > 1) {
    const End& from = u < 0 ? low_ : high_;
    const double beyond = u - (u < 0 ? -1 : 1);
    return from.value + beyond * (from.slope + beyond * from.curvature / 2);
  }
  return polynomial(u);
}

double SmoothCurve::slope_at(double x) const {
  const double step = 1e-4 * half_width_;
  return (at(x + step) - at(x - step)) / (2 * step);
}

SmoothFit fit_smooth_curve(std::span<const double> values, std::span<const double> weights,
                           std::size_t first, std::size_t last, int highest_degree,
                           double correlated) {
  const auto terms = static_cast<std::size_t>(highest_degree) + 1;
  const auto low = static_cast<double>(first);
  const auto high = static_cast<double>(last);
  std::vector<double> basis(terms);
  std::vector<double> matrix(terms * terms);
  std::vector<double> right(terms);
  double total_weight = 0;
  for (std::size_t i = first; i <= last; ++i) {
    legendre((2 * static_cast<double>(i) - low - high) / (high - low), basis);
    total_weight += weights[i];
    for (std::size_t r = 0; r < terms; ++r) {
      right[r] += weights[i] * basis[r] * values[i];
      for (std::size_t c = 0; c <= r; ++c)
        matrix[r * terms + c] += weights[i] * basis[r] * basis[c];
    }
  }
  const auto fit = [&](std::size_t size) {
    SmoothFit result{SmoothCurve{low, high, solve(matrix, right, size, terms)}, 0};
    double squares = 0;
    for (std::size_t i = first; i <= last; ++i) {
      const double residual = values[i] - result.curve.at(static_cast<double>(i));
      squares += weights[i] * residual * residual;
    }
    result.rms = std::sqrt(squares / std::max(total_weight, 1e-300));
    return result;
  };
  const double independent = std::max(2.0, static_cast<double>(last - first + 1) / correlated);
  constexpr double finest = 1e-6; // a residual below it is rounding, of any degree
  const auto cost = [&](const SmoothFit& candidate, std::size_t size) {
    return independent * std::log(candidate.rms * candidate.rms + finest * finest) +
           2 * static_cast<double>(size);
  };
  SmoothFit best = fit(2);
  double lowest = cost(best, 2);
  for (std::size_t size = 3; size <= terms; ++size) {
    SmoothFit candidate = fit(size);
    if (cost(candidate, size) < lowest) {
      lowest = cost(candidate, size);
      best = std::move(candidate);
    }
  }
  return best;
}

} // namespace octascope::pipeline
