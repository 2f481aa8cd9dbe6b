// The phase offset in use, and what it takes to move it.
#pragma once

#include <cstdint>
#include <optional>

#include "pipeline/scan/scan_lag_estimator.h"

namespace octascope::pipeline {

// Pure logic, one thread. An estimate that does not convince changes nothing. One that lies near
// the offset in use draws it half-way there, so that noise is averaged and a drift followed. One
// that lies farther off counts only when the next convincing one says the same: a single wrong
// estimate, however convincing, cannot make the picture jump.
class ScanLagTracker {
public:
  static constexpr double near_a_scans = 0.5;

  explicit ScanLagTracker(double start_a_scans) : in_use_a_scans_(start_a_scans) {}

  // True when the offset in use changed.
  bool update(const ScanLagEstimate& estimate);

  double in_use_a_scans() const { return in_use_a_scans_; }
  bool found() const { return used_ > 0; } // else it is still the starting value
  std::uint64_t used() const { return used_; }
  std::uint64_t refused() const { return refused_; }

private:
  double in_use_a_scans_;
  std::optional<double> far_a_scans_; // what the last estimate said, if it was far off
  std::uint64_t used_ = 0;
  std::uint64_t refused_ = 0; // not convincing, or far off and alone
};

} // namespace octascope::pipeline
