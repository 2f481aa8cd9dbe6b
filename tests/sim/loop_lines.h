// Lines of a simulated loop, and complex A-scans of them.
#pragma once

#include <complex>
#include <cstdint>
#include <span>
#include <vector>

#include "sim/spectra/volume_loop.h"
#include "tests/sim/exact_inverse.h"

namespace octascope::sim {

inline std::span<const std::uint16_t> line_of(const VolumeLoop& loop, std::uint64_t volume,
                                              int sweep, int line) {
  const auto frame = loop.frame(volume, sweep);
  const auto n = static_cast<std::size_t>(loop.format().samples_per_line);
  return {reinterpret_cast<const std::uint16_t*>(frame.data()) + static_cast<std::size_t>(line) * n,
          n};
}

// Bins 0 … N/2, each `offset_bins` deeper.
inline std::vector<std::complex<double>> a_scan(const VolumeLoop& loop, std::uint64_t volume,
                                                int sweep, int line, double offset_bins = 0) {
  const Spectrometer& s = loop.spectrometer();
  const tests::ReferenceChain chain(s.true_k_positions(), s.true_dispersion_rad());
  const auto counts = line_of(loop, volume, sweep, line);
  const std::vector<double> background = s.mean_counts({});
  std::vector<double> fringes(counts.size());
  for (std::size_t p = 0; p < fringes.size(); ++p)
    fringes[p] = counts[p] - background[p];
  const auto y = chain.prepare(fringes);
  std::vector<std::complex<double>> depths(counts.size() / 2);
  for (std::size_t d = 0; d < depths.size(); ++d)
    depths[d] = tests::ReferenceChain::at_depth(y, static_cast<double>(d) + offset_bins);
  return depths;
}

class Correlation {
public:
  void add(std::complex<double> a, std::complex<double> b) {
    product_ += a * std::conj(b);
    a_ += std::norm(a);
    b_ += std::norm(b);
    ++count_;
  }
  std::complex<double> complex_value() const { return product_ / std::sqrt(a_ * b_); }
  double value() const { return std::abs(complex_value()); }
  int count() const { return count_; }

private:
  std::complex<double> product_;
  double a_ = 0;
  double b_ = 0;
  int count_ = 0;
};

} // namespace octascope::sim
