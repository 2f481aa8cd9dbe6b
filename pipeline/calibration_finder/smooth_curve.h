// A smooth curve through noisy values: a weighted least-squares polynomial in Legendre form, with
// parabolic extrapolation outside the measured range.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace octascope::pipeline {

// Inside [first, last] the polynomial; outside, the parabola that best fits the outer fifth and
// meets the value at that end. A polynomial of high degree would diverge where there are no values,
// and its own curvature at the end is mostly noise.
class SmoothCurve {
public:
  SmoothCurve(double first, double last, std::vector<double> coefficients);

  double at(double x) const;
  double slope_at(double x) const; // per unit of x
  int degree() const { return static_cast<int>(coefficients_.size()) - 1; }

private:
  // In the coordinate u of the polynomial: value + slope·(u ∓ 1) + curvature·(u ∓ 1)²/2.
  struct End {
    double value = 0;
    double slope = 0;
    double curvature = 0;
  };
  End end(double sign) const;
  double polynomial(double u) const;

  double centre_;
  double half_width_;
  std::vector<double> coefficients_; // of P_n(u), u = (x − centre)/half width
  End low_;
  End high_;
};

struct SmoothFit {
  SmoothCurve curve;
  double rms = 0; // weighted, of the residuals
};

// `values[i]` was measured at x = i with `weights[i]` ≥ 0; only `first` ≤ i ≤ `last` is used.
// Values `correlated` or more samples apart are taken as independent. The degree, from 1 to
// `highest_degree`, minimises Akaike's information criterion, n·ln(rms²) + 2·terms for n
// independent values (H. Akaike, IEEE Transactions on Automatic Control 19, 1974). More than
// `highest_degree` values must have a weight above 0.
SmoothFit fit_smooth_curve(std::span<const double> values, std::span<const double> weights,
                           std::size_t first, std::size_t last, int highest_degree,
                           double correlated);

} // namespace octascope::pipeline
