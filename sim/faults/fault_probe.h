// One twin's view of the fault schedule: remembers what was already seen and counted.
//
// Not thread-safe: it belongs to the thread that works the twin. Allocates only when made.
#pragma once

#include <cstdint>
#include <vector>

#include "hal/clock.h"
#include "sim/faults/fault_schedule.h"

namespace octascope::sim {

class FaultProbe {
public:
  // `schedule` may be null: nothing ever breaks. Else it outlives the probe.
  FaultProbe(const FaultSchedule* schedule, pipeline::Device device);

  // Is the device out of its socket at `now`?
  bool unplugged(hal::TimePoint now) const { return active(gone_, now) != nullptr; }

  // Was it pulled since the last call of watch_plug() or of this, even if it is back already?
  bool pulled_since_last_look(hal::TimePoint now);
  void watch_plug(hal::TimePoint now) { looked_ = now; }

  // Null when no such fault runs. switch_index as in FaultSchedule::find_active.
  const ScriptedFault* active(pipeline::Fault kind, hal::TimePoint t, int switch_index = -1) const {
    return schedule_ == nullptr ? nullptr : schedule_->find_active(kind, t, switch_index);
  }

  // The next beginning or end of such a fault.
  std::optional<hal::TimePoint> next_edge(pipeline::Fault kind, hal::TimePoint after) const {
    return schedule_ == nullptr ? std::nullopt : schedule_->next_edge(kind, after);
  }

  // Call it once for each frame or pulse, with its time: the fault of this kind that hits it, or
  // null. Applies `every`, `probability` and `count`. Times should not decrease.
  const ScriptedFault* strike(pipeline::Fault kind, hal::TimePoint t);

  // Whether the script has any fault of this kind.
  bool expects(pipeline::Fault kind) const;

private:
  // How far one fault has come in its present occurrence.
  struct Tally {
    std::uint64_t occurrence = 0;
    std::uint64_t seen = 0; // frames or pulses that it could have hit
    std::uint64_t hit = 0;
  };

  static bool chooses(const ScriptedFault& fault, const Tally& tally);

  const FaultSchedule* schedule_;
  pipeline::Fault gone_;       // out of its socket
  std::vector<Tally> tallies_; // one for each fault of the script
  hal::TimePoint looked_{};
};

} // namespace octascope::sim
