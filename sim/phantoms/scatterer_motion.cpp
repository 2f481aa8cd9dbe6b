#include "sim/phantoms/scatterer_motion.h"

#include <algorithm>
#include <cmath>

namespace octascope::sim {

std::complex<double> field_correlation(const ScattererMotion& motion, double seconds) {
  const double across = double{motion.across_mm_per_s} * 1e3 * seconds / lateral_cell_um;
  const double along = double{motion.along_mm_per_s} * 1e3 * seconds / axial_cell_um;
  const double share{motion.share};
  return (1 - share) + std::polar(share * std::exp(-across * across - along * along),
                                  phase_rad_per_mm * double{motion.along_mm_per_s} * seconds);
}

std::array<std::complex<float>, most_repeats> repeat_weights(const ScattererMotion& motion,
                                                             std::span<const double> times_s) {
  constexpr double nothing_new = 1e-9; // a repeat that the others decide, but for rounding
  std::array<std::array<std::complex<double>, most_repeats>, most_repeats> factor{};
  const std::size_t count = std::min(times_s.size(), most_repeats);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      std::complex<double> left = field_correlation(motion, times_s[i] - times_s[j]);
      for (std::size_t k = 0; k < j; ++k)
        left -= factor[i][k] * std::conj(factor[j][k]);
      if (i == j)
        factor[i][i] = std::sqrt(std::max(left.real(), 0.0));
      else if (factor[j][j].real() > nothing_new)
        factor[i][j] = left / factor[j][j];
    }
  }
  std::array<std::complex<float>, most_repeats> weights{};
  if (count > 0)
    std::ranges::transform(factor[count - 1], weights.begin(),
                           [](const std::complex<double>& w) { return std::complex<float>{w}; });
  return weights;
}

} // namespace octascope::sim
