// Raw spectra of scattering tissue whose surface lies where the test wants it, on either side of
// zero delay: what lies above is folded by the physics of the real-valued signal and by nothing
// else.
#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

#include "pipeline/reconstruction/spectra_file.h"

namespace octascope::tests {

// `surface_bins(b, a)`: depth of the tissue's surface in bins, negative above zero delay. Tissue is
// `thickness_bins` thick and fades downwards by 0.2 dB a bin; 12-bit counts, 3 of them noise,
// uniform in k. Seeded.
inline std::vector<std::uint16_t>
scattering_spectra(const pipeline::SpectraShape& shape,
                   const std::function<double(int b, int a)>& surface_bins,
                   double thickness_bins = 50) {
  constexpr double two_pi = 2 * std::numbers::pi;
  constexpr double fading_per_bin = 0.023;
  constexpr double strongest = 12; // counts of one scatterer
  std::mt19937 random{7};
  std::uniform_real_distribution<double> share{0, 1};
  std::normal_distribution<double> noise{0, 3};
  std::vector<std::uint16_t> counts;
  std::vector<double> line(static_cast<std::size_t>(shape.samples));
  for (int b = 0; b < shape.b_scans; ++b)
    for (int a = 0; a < shape.a_scans; ++a) {
      for (std::size_t p = 0; p < line.size(); ++p)
        line[p] = 2000 + noise(random);
      for (int scatterer = 0; scatterer < static_cast<int>(2 * thickness_bins); ++scatterer) {
        const double below = share(random) * thickness_bins;
        const double strength = strongest * std::exp(-fading_per_bin * below) * share(random);
        const double cycles = (surface_bins(b, a) + below) / shape.samples;
        const double phase = two_pi * share(random);
        for (std::size_t p = 0; p < line.size(); ++p)
          line[p] += strength * std::cos(two_pi * cycles * static_cast<double>(p) + phase);
      }
      for (const double value : line)
        counts.push_back(static_cast<std::uint16_t>(std::lround(value)));
    }
  return counts;
}

} // namespace octascope::tests
