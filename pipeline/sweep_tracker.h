// Which B-scan of which volume a camera frame is, by its timestamp.
//
// Sequence numbers alone cannot tell: a lost first frame, a restarted stream or a stuck counter
// would shift the picture sideways. The time since the trigger can: a B-scan lasts 1.76 ms, and
// timestamps are right within microseconds.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "hal/clock.h"
#include "pipeline/scan_plan.h"

namespace octascope::pipeline {

struct SweepSlot {
  std::uint64_t volume = 0;
  int b_scan = 0;
};

// Pure logic, one thread. Follows the scanner: sweeps start at the trigger's pulse or, when that
// was latched, at the end of the sweep before. Each frame placed corrects the estimated start by a
// quarter of its deviation, so the clock of the camera may drift against ours.
class SweepTracker {
public:
  explicit SweepTracker(const ScanPlan& plan)
      : period_(plan.b_scan_period()), duration_(plan.sweep_duration()), b_scans_(plan.b_scans) {}

  // The pulse for `volume` (> 0, counting up) was made. Returns when its sweep should end.
  hal::TimePoint armed(std::uint64_t volume, hal::TimePoint when);

  // Empty for a frame that belongs to none of the last three sweeps.
  std::optional<SweepSlot> place(hal::TimePoint first_line);

private:
  struct Sweep {
    std::uint64_t volume = 0; // 0: none yet
    hal::TimePoint start;
  };

  hal::Duration period_;
  hal::Duration duration_;
  int b_scans_;
  std::array<Sweep, 3> recent_{}; // newest first
};

} // namespace octascope::pipeline
