#include "sim/spectra/scan_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace octascope::sim {

namespace {

double sway(double amplitude, hal::Duration t, hal::Duration period) {
  if (amplitude == 0)
    return 0;
  return amplitude * std::sin(2 * std::numbers::pi * hal::to_seconds(t) / hal::to_seconds(period));
}

} // namespace

int ScanMotion::met_sweep(int sweep, int sweeps, int alike_every, int sweeps_per_b_scan,
                          hal::Duration t) const {
  const double offset = sweeps_per_b_scan * (sway(breathing_b_scans, t, breathing_period) +
                                             sway(drift_b_scans, t, drift_period));
  const int kind = sweep % alike_every;
  const int last = (sweeps - 1 - kind) / alike_every;
  const int met = sweep / alike_every + static_cast<int>(std::lround(offset / alike_every));
  return kind + alike_every * std::clamp(met, 0, last);
}

} // namespace octascope::sim
