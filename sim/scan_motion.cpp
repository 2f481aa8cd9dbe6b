#include "sim/scan_motion.h"

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

int ScanMotion::met_b_scan(int b_scan, int b_scans, hal::Duration t) const {
  const double offset =
      sway(breathing_b_scans, t, breathing_period) + sway(drift_b_scans, t, drift_period);
  return std::clamp(b_scan + static_cast<int>(std::lround(offset)), 0, b_scans - 1);
}

} // namespace octascope::sim
