// The scan lag in use, and when estimates change it.
#pragma once

#include <cstdint>
#include <optional>

#include "pipeline/scan/scan_lag_estimator.h"

namespace octascope::pipeline {

// Pure logic, one thread. An unconvincing estimate changes nothing. One near the lag in use moves
// it half-way, which averages noise and follows drift. One farther off counts only when the next
// convincing one agrees: a single wrong estimate cannot make the picture jump.
class ScanLagTracker {
public:
  static constexpr double near_a_scans = 0.5;

  explicit ScanLagTracker(double start_a_scans) : in_use_a_scans_(start_a_scans) {}

  // True when the lag in use changed.
  bool update(const ScanLagEstimate& estimate);

  double in_use_a_scans() const { return in_use_a_scans_; }
  bool found() const { return used_ > 0; } // else it is still the starting value
  std::uint64_t used() const { return used_; }
  std::uint64_t refused() const { return refused_; }

private:
  double in_use_a_scans_;
  std::optional<double> far_a_scans_; // the last estimate, if it was far off
  std::uint64_t used_ = 0;
  std::uint64_t refused_ = 0; // unconvincing, or far off and unconfirmed
};

} // namespace octascope::pipeline
