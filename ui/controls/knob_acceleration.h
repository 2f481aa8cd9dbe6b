// Knob acceleration: a slow detent is one unit, a fast one up to eight.
#pragma once

#include <cstdint>

#include "hal/clock.h"

namespace octascope::ui {

inline constexpr double most_acceleration = 8;

// The state of one knob after its events so far. A value: the next state follows from this one and
// an event, with explicit times.
struct KnobMotion {
  hal::TimePoint last{};
  std::int8_t direction = 0; // of the last event; 0 before the first
  double turns_per_s = 0;    // smoothed over 150 ms; 0 at a change of direction
  double units = 0;          // of the last event, signed: slow units × acceleration

  // After `detents` more, at `time`; a time before the last event's is taken as that.
  KnobMotion turned(std::int32_t detents, int detents_per_turn, hal::TimePoint time) const;
};

// Units of a slow turn: a detent is one for knobs of up to 24 detents a turn, less for finer ones.
// Pure.
double slow_units(std::int32_t detents, int detents_per_turn);

// Units per slow unit: 1 up to half a turn a second, 8 from four turns on, smooth and monotone
// between. Pure.
double acceleration(double turns_per_s);

// A stick's response to a deflection of −1000…1000: 0 within the dead zone of 8 %, ±1 at the ends,
// odd, continuous, and steeper outwards, for fine control near the middle. Pure.
double axis_response(std::int32_t value);

} // namespace octascope::ui
