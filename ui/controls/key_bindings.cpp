#include "ui/controls/key_bindings.h"

#include <algorithm>
#include <vector>

#include "ui/view/action_table.h"

namespace octascope::ui {

namespace {

using hal::Key;

constexpr std::uint16_t code(Key key) {
  return static_cast<std::uint16_t>(key);
}

// A key for one way repeats while it is held down. One for both goes down, and up with shift; one
// of a choice goes on, and with shift back.
KeyBinding binding(const ActionRow& row, const ActionKey& key) {
  const bool continuous = row.kind == ActionKind::continuous;
  if (key.step != 0)
    return {key.key, row.action, key.step, key.step, continuous};
  if (continuous)
    return {key.key, row.action, -1, 1, true};
  return {key.key, row.action, 1, row.kind == ActionKind::choice ? -1 : 1, false};
}

std::vector<KeyBinding> bindings_of_the_table() {
  std::vector<KeyBinding> bindings;
  for (const ActionRow& row : action_table())
    for (const ActionKey& key : row.keys)
      if (key.key != 0)
        bindings.push_back(binding(row, key));
  return bindings;
}

} // namespace

std::span<const KeyBinding> key_bindings() {
  static const std::vector<KeyBinding> bindings = bindings_of_the_table();
  return bindings;
}

std::optional<KeyBinding> binding_of(std::uint16_t key) {
  const auto bindings = key_bindings();
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
