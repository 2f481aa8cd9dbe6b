// The actions of keys, pedals, knobs and pucks. Their names, keys and values: action_table.h.
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
  adjust, // turns or does the action selected with next_parameter
  freeze,
  rolling, // each B-scan is shown as it comes
  technique,
  transfer,
  colours,
  opacity,
  see_through,
  layout,
  stereo,
  parallax,
  b_scan,
  cut,
  crossed_b_scan, // the position of the one across all B-scans
  zoom_to_tissue,
  calliper,
  mark_1_across, // turning a mark shows the calliper
  mark_1_depth,
  mark_2_across,
  mark_2_depth,
  vessels,
  vessel_opacity,
  vessel_colours,
  vessel_shift_x, // in the volume's frame: x along a B-scan, y from B-scan to B-scan, z with depth
  vessel_shift_y,
  vessel_shift_z,
  vessel_turn_x,
  vessel_turn_y,
  vessel_turn_z,
  vessel_account,
  keep_registration,  // saves the shifted and turned registration to a file
  reset_registration, // undoes shifts and turns
  box,
  snapshot,
  record,
  figures, // the machine's, in the engineer's strip
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
  continuous, // changes a value by detents
  choice,     // one of several: a step selects the next, a negative step the previous
  toggle,     // a press switches over; a knob turned right switches on, left off
  momentary,  // happens once; not for knobs
  deliberate, // happens once; also when a knob is turned right
};

ActionKind kind_of(Action action);

// Whether a knob can trigger it.
constexpr bool takes_detents(ActionKind kind) {
  return kind != ActionKind::momentary;
}
// Whether a negative step of a switch differs from a positive one.
constexpr bool has_direction(ActionKind kind) {
  return kind == ActionKind::continuous || kind == ActionKind::choice;
}

// As in profiles and reports: "window_offset".
std::string_view to_string(Action action);
std::optional<Action> action_named(std::string_view name);

// As on the display: "Window offset".
std::string_view label_of(Action action);

// Whether it moves a mark of the calliper.
bool moves_mark(Action action);

// Whether it changes the display window.
bool changes_window(Action action);

} // namespace octascope::ui
