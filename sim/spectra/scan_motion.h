// Patient motion by breathing and drift: the scan hits tissue a few B-scans off its target.
#pragma once

#include "hal/clock.h"

namespace octascope::sim {

// The offset at time t is  breathing · sin(2π t / breathing period) + drift · sin(2π t / drift
// period), in B-scans, rounded, and limited to the first and last B-scan. A function of t alone, so
// the motion is the same in every run.
struct ScanMotion {
  double breathing_b_scans = 0; // amplitudes; 0: the patient holds still
  double drift_b_scans = 0;
  hal::Duration breathing_period = std::chrono::seconds{4};
  hal::Duration drift_period = std::chrono::seconds{60};

  // The source's sweep that is hit when `sweep` of `sweeps` was the target. Sweeps of the same
  // direction and repeat are `alike_every` apart. The result is always one of the target's kind,
  // because the mirror's movement does not depend on the patient.
  int met_sweep(int sweep, int sweeps, int alike_every, int sweeps_per_b_scan,
                hal::Duration t) const;
};

} // namespace octascope::sim
