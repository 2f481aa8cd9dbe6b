#include "ui/controls/knob_acceleration.h"

#include <algorithm>
#include <cmath>

namespace octascope::ui {

namespace {

constexpr double smoothing_s = 0.15;
constexpr double shortest_s = 1e-3; // events that arrive in one packet
constexpr double plain_detents_per_turn = 24;
constexpr double slow_turns_per_s = 0.5;
constexpr double fast_turns_per_s = 4;
constexpr double dead_zone = 0.08;

} // namespace

double slow_units(std::int32_t detents, int detents_per_turn) {
  return detents * std::min(1.0, plain_detents_per_turn / detents_per_turn);
}

double acceleration(double turns_per_s) {
  if (turns_per_s <= slow_turns_per_s)
    return 1;
  // Speed is felt in ratios.
  const double t = std::min(1.0, std::log(turns_per_s / slow_turns_per_s) /
                                     std::log(fast_turns_per_s / slow_turns_per_s));
  return 1 + (most_acceleration - 1) * t * t * (3 - 2 * t);
}

KnobMotion KnobMotion::turned(std::int32_t detents, int detents_per_turn,
                              hal::TimePoint time) const {
  if (detents == 0)
    return *this;
  KnobMotion next;
  next.last = std::max(time, last);
  next.direction = detents > 0 ? std::int8_t{1} : std::int8_t{-1};
  const double turns = std::abs(static_cast<double>(detents)) / detents_per_turn;
  if (next.direction == direction) {
    const double passed_s = std::max(hal::to_seconds(next.last - last), shortest_s);
    const double kept = std::exp(-passed_s / smoothing_s);
    next.turns_per_s = turns_per_s * kept + turns / passed_s * (1 - kept);
  }
  next.units = slow_units(detents, detents_per_turn) * acceleration(next.turns_per_s);
  return next;
}

double axis_response(std::int32_t value) {
  const double deflection = std::clamp(static_cast<double>(value) / 1000, -1.0, 1.0);
  const double beyond = std::max(0.0, std::abs(deflection) - dead_zone) / (1 - dead_zone);
  // Between a straight line and a parabola, so that it neither creeps nor jumps.
  return std::copysign(0.25 * beyond + 0.75 * beyond * beyond, deflection);
}

} // namespace octascope::ui
