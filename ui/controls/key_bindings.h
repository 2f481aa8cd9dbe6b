// What each key of a keyboard does.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "hal/display.h"
#include "ui/view/action.h"

namespace octascope::ui {

struct KeyBinding {
  std::uint16_t key = 0; // hal::DisplayEvent::key
  Action action = Action::freeze;
  int step = 1;
  int shifted = 1;      // the step with shift
  bool repeats = false; // while the key is held down
};

// From the action table, in its order; keys of the same action are adjacent.
std::span<const KeyBinding> key_bindings();

// Empty: the key does nothing.
std::optional<KeyBinding> binding_of(std::uint16_t key);

// "page up", "o".
std::string key_name(std::uint16_t key);

} // namespace octascope::ui
