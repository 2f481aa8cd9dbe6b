// One switch contact of the simulated pedal, with its possible faults.
//
// The contact follows the foot at once, with a burst of bounces, or not at all while it is stuck.
// Pure logic over explicit times.
#pragma once

#include <optional>

#include "hal/clock.h"
#include "hal/switch_debouncer.h"
#include "sim/faults/fault_script.h"

namespace octascope::sim {

class BouncingContact {
public:
  // The foot goes down or up at `t`. With a `bounce` fault the contact then opens and closes that
  // many times, evenly over its bounce_spread, before it settles. A new move ends an older burst.
  void foot(hal::TimePoint t, bool pressed, const ScriptedFault* bounce);

  // From `t` on the contact is stuck at `level`, or follows the foot again (empty).
  void stick(hal::TimePoint t, std::optional<bool> level);

  // The time of the next bounce or debounced change, if the foot does not move.
  std::optional<hal::TimePoint> next_time() const;

  // Advances to `t`, which must not be after next_time(). Returns the debounced change, if any.
  std::optional<hal::SwitchChange> play_to(hal::TimePoint t);

  // The state last reported by the device.
  bool reported() const { return debouncer_.closed(); }

  // The total number of bounces that the debouncer removed.
  std::uint64_t bounces() const { return debouncer_.bounces(); }

  // Foot up, nothing pending, nothing to report.
  void reset();

private:
  bool level() const;
  void touch(hal::TimePoint t);

  hal::SwitchDebouncer debouncer_;
  bool foot_ = false;
  std::optional<bool> stuck_;
  int bounces_left_ = 0; // odd: the contact differs from the foot's position
  hal::Duration bounce_step_{};
  hal::TimePoint next_bounce_{};
};

} // namespace octascope::sim
