// Knob acceleration: a slow detent is one unit, a fast one up to eight.
#pragma once

#include <cstdint>

#include "hal/clock.h"

namespace octascope::ui {

inline constexpr double most_acceleration = 8;

// What one knob's events told so far. A value: the next one follows from the last and an event
// alone, with explicit times.
struct KnobMotion {
  hal::TimePoint last{};
  std::int8_t direction = 0; // of the last event; 0 before the first
  double turns_per_s = 0;    // smoothed over 150 ms; 0 where a direction begins
  double units = 0;          // of the last event, signed: slow units × acceleration

  // After `detents` more, at `time`; a time before the last event's counts as that.
  KnobMotion turned(std::int32_t detents, int detents_per_turn, hal::TimePoint time) const;
};

// Units of a slow turn: a detent of a knob of up to 24 a turn is one, of finer ones less. Pure.
double slow_units(std::int32_t detents, int detents_per_turn);

// Units per slow unit: 1 up to half a turn a second, 8 from four turns on, smooth and
// never falling between. Pure.
double acceleration(double turns_per_s);

// The response of a stick to a deflection of −1000…1000: 0 within the dead zone of 8 %, ±1 at the
// ends, odd, steeper outwards (fine near the middle), without a jump. Pure.
double axis_response(std::int32_t value);

} // namespace octascope::ui
