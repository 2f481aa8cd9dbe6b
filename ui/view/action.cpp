#include "ui/view/action.h"

namespace octascope::ui {

namespace {

struct Description {
  std::string_view name;
  std::string_view label;
  ActionKind kind;
};

// In the order of the enumeration.
constexpr std::array<Description, action_count> descriptions{{
    {"window_offset", "Window offset", ActionKind::continuous},
    {"window_size", "Window size", ActionKind::continuous},
    {"auto_window", "Automatic window", ActionKind::momentary},
    {"rotate", "Rotation", ActionKind::continuous},
    {"tilt", "Tilt", ActionKind::continuous},
    {"distance", "Distance", ActionKind::continuous},
    {"reset_view", "First view", ActionKind::momentary},
    {"next_parameter", "Next function", ActionKind::choice},
    {"previous_parameter", "Previous function", ActionKind::choice},
    {"adjust", "Adjust", ActionKind::continuous},
    {"freeze", "Freeze", ActionKind::toggle},
    {"technique", "Technique", ActionKind::choice},
    {"transfer", "Transfer", ActionKind::choice},
    {"colours", "Colours", ActionKind::choice},
    {"layout", "Layout", ActionKind::choice},
    {"stereo", "Stereo", ActionKind::choice},
    {"parallax", "Parallax", ActionKind::continuous},
    {"b_scan", "B-scan", ActionKind::continuous},
    {"vessels", "Vessels", ActionKind::toggle},
    {"vessel_opacity", "Vessel opacity", ActionKind::continuous},
    {"vessel_colours", "Vessel colours", ActionKind::choice},
    {"vessel_shift_x", "Shift vessels, x", ActionKind::continuous},
    {"vessel_shift_y", "Shift vessels, y", ActionKind::continuous},
    {"vessel_shift_z", "Shift vessels, z", ActionKind::continuous},
    {"vessel_turn_x", "Turn vessels, x", ActionKind::continuous},
    {"vessel_turn_y", "Turn vessels, y", ActionKind::continuous},
    {"vessel_turn_z", "Turn vessels, z", ActionKind::continuous},
    {"vessel_account", "Vessel account", ActionKind::toggle},
    {"keep_registration", "Keep vessels' place", ActionKind::deliberate},
    {"reset_registration", "Vessels' place, back", ActionKind::deliberate},
    {"box", "Box", ActionKind::toggle},
    {"snapshot", "Snapshot", ActionKind::momentary},
    {"record", "Recording", ActionKind::momentary},
    {"legend", "Legend", ActionKind::toggle},
}};

} // namespace

ActionKind kind_of(Action action) {
  return descriptions[index_of(action)].kind;
}

std::string_view to_string(Action action) {
  return descriptions[index_of(action)].name;
}

bool changes_window(Action action) {
  return action == Action::window_offset || action == Action::window_size ||
         action == Action::auto_window;
}

std::string_view label_of(Action action) {
  return descriptions[index_of(action)].label;
}

std::optional<Action> action_named(std::string_view name) {
  for (const Action action : all_actions())
    if (to_string(action) == name)
      return action;
  return std::nullopt;
}

} // namespace octascope::ui
