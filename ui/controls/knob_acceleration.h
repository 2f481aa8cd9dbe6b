// Knob acceleration: a slow detent counts as one unit, a fast one as up to eight.
#pragma once

#include <cstdint>

#include "hal/clock.h"

namespace octascope::ui {

inline constexpr double most_acceleration = 8;

// The motion of one knob. A value: the next one depends only on the previous one and the event.
// Times are explicit.
struct KnobMotion {
  hal::TimePoint last{};
  std::int8_t direction = 0; // of the last event; 0 before the first
  double turns_per_s = 0;    // smoothed over 150 ms; 0 at the first event of a direction
  double units = 0;          // of the last event, signed: slow units × acceleration

  // The motion after `detents` more, at `time`. Times before the last event count as its time.
  KnobMotion turned(std::int32_t detents, int detents_per_turn, hal::TimePoint time) const;
};

// Units of a slow turn: one per detent for up to 24 detents per turn, less for finer knobs. Pure.
double slow_units(std::int32_t detents, int detents_per_turn);

// Units per slow unit: 1 up to half a turn per second, 8 from four turns per second on, smooth and
// monotonic between. Pure.
double acceleration(double turns_per_s);

// The response of a stick to a deflection of −1000…1000: 0 within the dead zone of 8 %, ±1 at the
// ends; odd, continuous, and steeper outwards for fine control near the middle. Pure.
double axis_response(std::int32_t value);

} // namespace octascope::ui
