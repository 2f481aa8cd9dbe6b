// One switch contact of the simulated pedal, with its faults.
//
// The contact follows the foot at once, with a burst of bounces, or not at all while stuck. Pure
// logic over explicit times.
#pragma once

#include <optional>

#include "hal/clock.h"
#include "hal/switch_debouncer.h"
#include "sim/faults/fault_script.h"

namespace octascope::sim {

class BouncingContact {
public:
  // The foot goes down or up at `t`. With a `bounce` fault the contact then opens and closes that
  // often, evenly over the fault's time, before it settles; a new move ends an older burst.
  void foot(hal::TimePoint t, bool pressed, const ScriptedFault* bounce);

  // From `t` on the contact is stuck at `level`; empty: it follows the foot again.
  void stick(hal::TimePoint t, std::optional<bool> level);

  // The time of the next event if the foot does not move: a bounce, or a confirmed change.
  std::optional<hal::TimePoint> next_time() const;

  // Advances to `t`, at most next_time(); returns the change confirmed by then.
  std::optional<hal::SwitchChange> play_to(hal::TimePoint t);

  // The state last reported.
  bool reported() const { return debouncer_.closed(); }

  // Total number of bounces removed by the debouncer.
  std::uint64_t bounces() const { return debouncer_.bounces(); }

  // Foot up, nothing pending.
  void reset();

private:
  bool level() const;
  void touch(hal::TimePoint t);

  hal::SwitchDebouncer debouncer_;
  bool foot_ = false;
  std::optional<bool> stuck_;
  int bounces_left_ = 0; // odd: the contact is opposite to the foot
  hal::Duration bounce_step_{};
  hal::TimePoint next_bounce_{};
};

} // namespace octascope::sim
