// The patient breathes and drifts: the scan meets the tissue a few B-scans away.
#pragma once

#include "hal/clock.h"

namespace octascope::sim {

// The offset at time t is breathing · sin(2π t / breathing period) + drift · sin(2π t / drift
// period), in B-scans, rounded; past the first and last B-scan the picture stands still. A function
// of t alone, so every run moves the same way.
struct ScanMotion {
  double breathing_b_scans = 0; // amplitudes; 0: the patient holds still
  double drift_b_scans = 0;
  hal::Duration breathing_period = std::chrono::seconds{4};
  hal::Duration drift_period = std::chrono::seconds{60};

  // The source's sweep that is met when `sweep` of `sweeps` was aimed at. Only sweeps of the same
  // direction and repeat, `alike_every` apart, are met: the mirror's motion does not depend on the
  // patient.
  int met_sweep(int sweep, int sweeps, int alike_every, int sweeps_per_b_scan,
                hal::Duration t) const;
};

} // namespace octascope::sim
