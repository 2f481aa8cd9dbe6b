// The chain that undoes the spectrometer, plain and in double precision: the tests' own, so that
// it shares nothing with what it judges.
#pragma once

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <span>
#include <vector>

namespace octascope::tests {

inline std::vector<double> hann(std::size_t n) {
  std::vector<double> w(n);
  for (std::size_t m = 0; m < n; ++m)
    w[m] = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * static_cast<double>(m) /
                                static_cast<double>(n - 1));
  return w;
}

class ReferenceChain {
public:
  ReferenceChain(std::span<const double> k_positions, std::span<const double> dispersion_rad)
      : k_(k_positions.begin(), k_positions.end()),
        theta_(dispersion_rad.begin(), dispersion_rad.end()), window_(hann(k_.size())) {}

  const std::vector<double>& window() const { return window_; }

  // Background-free counts → y[m] = s(r[m])·w[m]·exp(iθ[m]), with a sinc of 64 taps.
  std::vector<std::complex<double>> prepare(std::span<const double> s) const {
    std::vector<std::complex<double>> y(k_.size());
    for (std::size_t m = 0; m < y.size(); ++m)
      y[m] = std::polar(window_[m] * interpolated(s, k_[m]), theta_[m]);
    return y;
  }

  // Y(d)/N at any fraction of a bin.
  static std::complex<double> at_depth(std::span<const std::complex<double>> y, double depth_bin) {
    const double n = static_cast<double>(y.size());
    std::complex<double> sum = 0;
    for (std::size_t m = 0; m < y.size(); ++m)
      sum += y[m] * std::polar(1.0, -2 * std::numbers::pi * depth_bin * static_cast<double>(m) / n);
    return sum / n;
  }

  struct Peak {
    double depth_bin;
    double level_db;
  };
  // The highest place between two depths, to 0.01 bin.
  static Peak peak(std::span<const std::complex<double>> y, double from, double to) {
    Peak best{from, -1e9};
    const auto look = [&](double first, double last, double step) {
      for (double d = first; d <= last; d += step)
        if (const double level = 20 * std::log10(std::abs(at_depth(y, d))); level > best.level_db)
          best = {d, level};
    };
    look(from, to, 0.25);
    look(best.depth_bin - 0.25, best.depth_bin + 0.25, 0.01);
    return best;
  }

private:
  static double interpolated(std::span<const double> s, double position) {
    constexpr int half = 32;
    const int base = static_cast<int>(std::floor(position));
    double sum = 0;
    for (int p = std::max(base - half + 1, 0);
         p <= std::min(base + half, static_cast<int>(s.size()) - 1); ++p) {
      const double x = position - p;
      const double angle = std::numbers::pi * x;
      const double sinc = std::abs(x) < 1e-12 ? 1 : std::sin(angle) / angle;
      sum += s[static_cast<std::size_t>(p)] * sinc * (0.5 + 0.5 * std::cos(angle / half));
    }
    return sum;
  }

  std::vector<double> k_;
  std::vector<double> theta_;
  std::vector<double> window_;
};

} // namespace octascope::tests
