// The patient breathes and drifts: the scan meets the tissue a few B-scans away.
#pragma once

#include "hal/clock.h"

namespace octascope::sim {

// The offset at time t is  breathing · sin(2π t / breathing period) + drift · sin(2π t / drift
// period), in B-scans, rounded; past the first and last B-scan the picture stands still. A function
// of t alone, so every run moves the same way.
struct ScanMotion {
  double breathing_b_scans = 0; // amplitudes; 0 is a patient who holds still
  double drift_b_scans = 0;
  hal::Duration breathing_period = std::chrono::seconds{4};
  hal::Duration drift_period = std::chrono::seconds{60};

  // The B-scan of the source that is met where `b_scan` of `b_scans` was aimed at.
  int met_b_scan(int b_scan, int b_scans, hal::Duration t) const;
};

} // namespace octascope::sim
