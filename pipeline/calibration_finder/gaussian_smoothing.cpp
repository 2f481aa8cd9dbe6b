#include "pipeline/calibration_finder/gaussian_smoothing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace octascope::pipeline {

std::vector<double> smooth_gaussian(std::span<const double> values, double sigma) {
  const auto reach = static_cast<std::ptrdiff_t>(std::ceil(3 * sigma));
  std::vector<double> kernel(static_cast<std::size_t>(reach) + 1);
  for (std::size_t i = 0; i < kernel.size(); ++i) {
    const double x = static_cast<double>(i) / sigma;
    kernel[i] = std::exp(-x * x / 2);
  }
  const auto n = static_cast<std::ptrdiff_t>(values.size());
  std::vector<double> means(values.size());
  for (std::ptrdiff_t p = 0; p < n; ++p) {
    double sum = 0;
    double weight = 0;
    for (std::ptrdiff_t q = std::max<std::ptrdiff_t>(0, p - reach); q <= std::min(n - 1, p + reach);
         ++q) {
      const double w = kernel[static_cast<std::size_t>(std::abs(q - p))];
      sum += w * values[static_cast<std::size_t>(q)];
      weight += w;
    }
    means[static_cast<std::size_t>(p)] = sum / weight;
  }
  return means;
}

} // namespace octascope::pipeline
