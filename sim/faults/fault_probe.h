// One twin's view of the fault schedule: remembers what it has seen and counted.
//
// Not thread-safe: belongs to the twin's thread. Allocates only when made.
#pragma once

#include <cstdint>
#include <vector>

#include "hal/clock.h"
#include "sim/faults/fault_schedule.h"

namespace octascope::sim {

class FaultProbe {
public:
  // `schedule` may be null: no faults. Otherwise it must outlive the probe.
  FaultProbe(const FaultSchedule* schedule, pipeline::Device device);

  // Whether the device is unplugged at `now`.
  bool unplugged(hal::TimePoint now) const { return active(gone_, now) != nullptr; }

  // Whether it was unplugged since the last call of watch_plug() or of this, even if it is back.
  bool pulled_since_last_look(hal::TimePoint now);
  void watch_plug(hal::TimePoint now) { looked_ = now; }

  // The active fault, or null. switch_index as in FaultSchedule::find_active.
  const ScriptedFault* active(pipeline::Fault kind, hal::TimePoint t, int switch_index = -1) const {
    return schedule_ == nullptr ? nullptr : schedule_->find_active(kind, t, switch_index);
  }

  // The next beginning or end of such a fault.
  std::optional<hal::TimePoint> next_edge(pipeline::Fault kind, hal::TimePoint after) const {
    return schedule_ == nullptr ? std::nullopt : schedule_->next_edge(kind, after);
  }

  // Call once for each frame or pulse with its time: returns the fault of this kind that hits it,
  // or null. Applies `every`, `probability` and `count`. Times should not decrease.
  const ScriptedFault* strike(pipeline::Fault kind, hal::TimePoint t);

  // Whether the script has any fault of this kind.
  bool expects(pipeline::Fault kind) const;

private:
  // The progress of one fault in its present occurrence.
  struct Tally {
    std::uint64_t occurrence = 0;
    std::uint64_t seen = 0; // frames or pulses seen
    std::uint64_t hit = 0;
  };

  static bool chooses(const ScriptedFault& fault, const Tally& tally);

  const FaultSchedule* schedule_;
  pipeline::Fault gone_;       // the device's "unplugged" fault
  std::vector<Tally> tallies_; // one per fault of the script
  hal::TimePoint looked_{};
};

} // namespace octascope::sim
