// Everything that hands and feet can ask for. What each is called and does: action_table.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace octascope::ui {

enum class Action : std::uint8_t {
  window_offset,
  window_size,
  auto_window,
  rotate,
  tilt,
  distance,
  reset_view,
  next_parameter,
  previous_parameter,
  adjust, // turns or does whatever was chosen with next_parameter
  freeze,
  technique,
  transfer,
  colours,
  layout,
  stereo,
  parallax,
  b_scan,
  vessels,
  vessel_opacity,
  vessel_colours,
  vessel_shift_x, // in the volume's frame, x along a B-scan, y from B-scan to B-scan, z with depth
  vessel_shift_y,
  vessel_shift_z,
  vessel_turn_x,
  vessel_turn_y,
  vessel_turn_z,
  vessel_account,
  keep_registration,  // what the shifts and turns have made of it, in a file
  reset_registration, // undoes them
  box,
  snapshot,
  record,
  legend,
};

constexpr std::size_t index_of(Action action) {
  return static_cast<std::size_t>(action);
}

inline constexpr std::size_t action_count = index_of(Action::legend) + 1; // legend is the last

// Every action, in the order of the enumeration.
constexpr std::array<Action, action_count> all_actions() {
  std::array<Action, action_count> all{};
  for (std::size_t i = 0; i < action_count; ++i)
    all[i] = static_cast<Action>(i);
  return all;
}

enum class ActionKind : std::uint8_t {
  continuous, // takes detents, the more the farther
  choice,     // one of several: a step goes to the next, a negative one back
  toggle,     // a press changes it over; turned, right is on and left is off
  momentary,  // happens once; cannot be turned
  deliberate, // happens once; turned, right does it
};

ActionKind kind_of(Action action);

// May a knob do it?
constexpr bool takes_detents(ActionKind kind) {
  return kind != ActionKind::momentary;
}
// Does a negative step differ from a positive one when a switch does it?
constexpr bool has_direction(ActionKind kind) {
  return kind == ActionKind::continuous || kind == ActionKind::choice;
}

// As in profiles and reports: "window_offset".
std::string_view to_string(Action action);
std::optional<Action> action_named(std::string_view name);

// As on the display: "Window offset".
std::string_view label_of(Action action);

// Whether it changes the display window.
bool changes_window(Action action);

} // namespace octascope::ui
