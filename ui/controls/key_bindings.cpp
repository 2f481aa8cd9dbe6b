#include "ui/controls/key_bindings.h"

#include <algorithm>
#include <array>

namespace octascope::ui {

namespace {

using hal::Key;

constexpr std::uint16_t code(Key key) {
  return static_cast<std::uint16_t>(key);
}

// Of those for the same action, neighbours.
constexpr std::array bindings{
    KeyBinding{'o', Action::window_offset, -1, 1, true},
    KeyBinding{'s', Action::window_size, -1, 1, true},
    KeyBinding{'w', Action::auto_window},
    KeyBinding{code(Key::left), Action::rotate, -1, -1, true},
    KeyBinding{code(Key::right), Action::rotate, 1, 1, true},
    KeyBinding{code(Key::up), Action::tilt, 1, 1, true},
    KeyBinding{code(Key::down), Action::tilt, -1, -1, true},
    KeyBinding{code(Key::page_up), Action::distance, -1, -1, true},
    KeyBinding{code(Key::page_down), Action::distance, 1, 1, true},
    KeyBinding{'+', Action::distance, -1, -1, true},
    KeyBinding{'=', Action::distance, -1, -1, true},
    KeyBinding{'-', Action::distance, 1, 1, true},
    KeyBinding{code(Key::home), Action::reset_view},
    KeyBinding{'[', Action::b_scan, -1, -1, true},
    KeyBinding{']', Action::b_scan, 1, 1, true},
    KeyBinding{code(Key::tab), Action::next_parameter, 1, -1},
    KeyBinding{code(Key::space), Action::freeze},
    KeyBinding{'t', Action::technique, 1, -1},
    KeyBinding{'f', Action::transfer, 1, -1},
    KeyBinding{'c', Action::colours, 1, -1},
    KeyBinding{'l', Action::layout, 1, -1},
    KeyBinding{'d', Action::stereo, 1, -1},
    KeyBinding{'x', Action::parallax, -1, 1, true},
    KeyBinding{'v', Action::vessels},
    KeyBinding{'a', Action::vessel_opacity, -1, 1, true},
    KeyBinding{'e', Action::vessel_colours, 1, -1},
    KeyBinding{'i', Action::vessel_shift_x, -1, 1, true},
    KeyBinding{'j', Action::vessel_shift_y, -1, 1, true},
    KeyBinding{'k', Action::vessel_shift_z, -1, 1, true},
    KeyBinding{'u', Action::vessel_turn_x, -1, 1, true},
    KeyBinding{'y', Action::vessel_turn_y, -1, 1, true},
    KeyBinding{'z', Action::vessel_turn_z, -1, 1, true},
    KeyBinding{'n', Action::vessel_account},
    KeyBinding{'m', Action::keep_registration},
    KeyBinding{'g', Action::reset_registration},
    KeyBinding{'b', Action::box},
    KeyBinding{'p', Action::snapshot},
    KeyBinding{'r', Action::record},
    KeyBinding{'h', Action::legend},
    KeyBinding{code(Key::f1), Action::legend},
};

} // namespace

std::span<const KeyBinding> key_bindings() {
  return bindings;
}

std::optional<KeyBinding> binding_of(std::uint16_t key) {
  const auto found = std::ranges::find(bindings, key, &KeyBinding::key);
  return found == bindings.end() ? std::nullopt : std::optional{*found};
}

std::string key_name(std::uint16_t key) {
  switch (key) {
  case code(Key::left): return "left";
  case code(Key::right): return "right";
  case code(Key::up): return "up";
  case code(Key::down): return "down";
  case code(Key::page_up): return "page up";
  case code(Key::page_down): return "page down";
  case code(Key::home): return "home";
  case code(Key::tab): return "tab";
  case code(Key::space): return "space";
  case code(Key::f1): return "F1";
  default: return {static_cast<char>(key)};
  }
}

} // namespace octascope::ui
