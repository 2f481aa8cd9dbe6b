// One simulated device's view of the fault schedule, with what it has already seen and counted.
//
// Not thread-safe: belongs to the device's thread. Allocates only at construction.
#pragma once

#include <cstdint>
#include <vector>

#include "hal/clock.h"
#include "sim/faults/fault_schedule.h"

namespace octascope::sim {

class FaultProbe {
public:
  // `schedule` may be null: no faults. It must outlive the probe.
  FaultProbe(const FaultSchedule* schedule, pipeline::Device device);

  // Whether the device is unplugged at `now`.
  bool unplugged(hal::TimePoint now) const { return active(gone_, now) != nullptr; }

  // Whether it was unplugged since the last call of this or of watch_plug(), even if it is back.
  bool pulled_since_last_look(hal::TimePoint now);
  void watch_plug(hal::TimePoint now) { looked_ = now; }

  // The active fault of that kind, or null. switch_index as in FaultSchedule::find_active.
  const ScriptedFault* active(pipeline::Fault kind, hal::TimePoint t, int switch_index = -1) const {
    return schedule_ == nullptr ? nullptr : schedule_->find_active(kind, t, switch_index);
  }

  // The next beginning or end of a fault of that kind.
  std::optional<hal::TimePoint> next_edge(pipeline::Fault kind, hal::TimePoint after) const {
    return schedule_ == nullptr ? std::nullopt : schedule_->next_edge(kind, after);
  }

  // To be called once for each frame or pulse, with its time: the fault of this kind that hits it,
  // or null. Applies `every`, `probability` and `count`. Times should not decrease.
  const ScriptedFault* strike(pipeline::Fault kind, hal::TimePoint t);

  // Whether the script has any fault of this kind.
  bool expects(pipeline::Fault kind) const;

private:
  // The progress of one fault within its current occurrence.
  struct Tally {
    std::uint64_t occurrence = 0;
    std::uint64_t seen = 0; // frames or pulses that it could have hit
    std::uint64_t hit = 0;
  };

  static bool chooses(const ScriptedFault& fault, const Tally& tally);

  const FaultSchedule* schedule_;
  pipeline::Fault gone_;       // the kind for an unplugged device
  std::vector<Tally> tallies_; // one per fault of the script
  hal::TimePoint looked_{};
};

} // namespace octascope::sim
