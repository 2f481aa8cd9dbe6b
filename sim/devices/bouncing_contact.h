// One switch contact of the simulated pedal, with all that can be wrong with it.
//
// The foot presses; the contact follows: at once, with a burst of bounces, or not at all while it
// is stuck. Pure logic over explicit times.
#pragma once

#include <optional>

#include "hal/clock.h"
#include "hal/switch_debouncer.h"
#include "sim/faults/fault_script.h"

namespace octascope::sim {

class BouncingContact {
public:
  // The foot goes down or up at `t`. With a `bounce` fault the contact then opens and closes that
  // often, in even steps over the fault's time, before it rests; a new move ends an older burst.
  void foot(hal::TimePoint t, bool pressed, const ScriptedFault* bounce);

  // From `t` on the contact is stuck at a level, or follows the foot again (nothing).
  void stick(hal::TimePoint t, std::optional<bool> level);

  // When something happens next if the foot does not move: a bounce, or a change that is certain.
  std::optional<hal::TimePoint> next_time() const;

  // Plays on to `t`, which is next_time() or earlier; returns the change that is certain by then.
  std::optional<hal::SwitchChange> play_to(hal::TimePoint t);

  // As the device last reported it.
  bool reported() const { return debouncer_.closed(); }

  // That the debouncer took out, ever.
  std::uint64_t bounces() const { return debouncer_.bounces(); }

  // Foot up, nothing pending, nothing to report.
  void reset();

private:
  bool level() const;
  void touch(hal::TimePoint t);

  hal::SwitchDebouncer debouncer_;
  bool foot_ = false;
  std::optional<bool> stuck_;
  int bounces_left_ = 0; // an odd number: the contact is away from where the foot wants it
  hal::Duration bounce_step_{};
  hal::TimePoint next_bounce_{};
};

} // namespace octascope::sim
