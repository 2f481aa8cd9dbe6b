// Whether anything in B-scans scatters, before there is a calibration: power over depth against its
// noise. Without positions uniform in k what scatters is spread over many bins, but still rises.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace octascope::pipeline {

// Of lines of `samples` samples, at least fewest_fringe_samples (fringe.h) of them. Use it from one
// thread at a time.
class DepthPower {
public:
  explicit DepthPower(std::size_t samples);

  // [line][sample] in any unit, all finite; its mean line is the background.
  void add_b_scan(std::span<const double> counts);

  struct Highest {
    double above_noise_db = 0; // the noise is what one depth in ten is below; 0: no lines, no light
    std::size_t bin = 0;       // of the transform, nearer ones than 2·lowest_fringe_bin left out
  };
  Highest highest() const;

private:
  std::size_t samples_;
  std::vector<double> power_; // by bin, of all lines
};

} // namespace octascope::pipeline
