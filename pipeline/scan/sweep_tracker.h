// Which sweep of which volume a camera frame is, by its timestamp.
//
// Sequence numbers alone cannot tell: a lost first frame, a restarted stream or a stuck counter
// would shift the picture sideways. The time since the trigger can: a sweep lasts 1.76 ms, and
// timestamps are right within microseconds.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "hal/clock.h"
#include "pipeline/scan/scan_plan.h"

namespace octascope::pipeline {

struct SweepSlot {
  std::uint64_t volume = 0;
  int sweep = 0; // of the volume, from 0: repeats and backward sweeps count like any other
};

// Pure logic, one thread. A volume's sweeps start at the trigger pulse or, if that was latched,
// when the previous volume's sweeps end. If the scanner missed the previous pulse, nothing was
// latched: the time of the first frame shows this. Each placed frame corrects the estimated start
// by a quarter of its deviation, so the camera's clock may drift against ours.
class SweepTracker {
public:
  static constexpr std::size_t volumes = 3; // that a frame may belong to

  explicit SweepTracker(const ScanPlan& plan)
      : period_(plan.frame_period()), duration_(plan.sweep_duration()), sweeps_(plan.sweeps()) {}

  // The pulse for `volume` (> 0, counting up) was made. Returns when its last sweep should end.
  hal::TimePoint pulsed(std::uint64_t volume, hal::TimePoint when);

  // Empty for a frame that belongs to none of the last volumes.
  std::optional<SweepSlot> place(hal::TimePoint first_line);

private:
  struct Start {
    std::uint64_t volume = 0; // 0: none yet
    hal::TimePoint when;
    hal::TimePoint pulse;
    bool answered = false; // by a frame
  };

  void reconsider_latch(Start& start, const Start& before, hal::TimePoint first_line) const;

  hal::Duration period_;
  hal::Duration duration_;
  int sweeps_;                          // of a volume
  std::array<Start, volumes> recent_{}; // newest first
};

} // namespace octascope::pipeline
