#include "pipeline/scan/scan_lag_tracker.h"

#include <cmath>

namespace octascope::pipeline {

bool ScanLagTracker::update(const ScanLagEstimate& estimate) {
  if (!estimate.convincing()) {
    ++refused_;
    return false;
  }
  const double said = estimate.scan_lag_a_scans;
  const double change = said - in_use_a_scans_;
  if (std::abs(change) <= near_a_scans) {
    in_use_a_scans_ += change / 2;
  } else if (far_a_scans_ && std::abs(said - *far_a_scans_) <= near_a_scans) {
    in_use_a_scans_ = (said + *far_a_scans_) / 2;
  } else {
    far_a_scans_ = said;
    ++refused_;
    return false;
  }
  far_a_scans_.reset();
  ++used_;
  return true;
}

} // namespace octascope::pipeline
