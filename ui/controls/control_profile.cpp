#include "ui/controls/control_profile.h"

#include <algorithm>
#include <array>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "pipeline/files/config_document.h"
#include "ui/controls/profile_rules.h"

namespace octascope::ui {

using pipeline::ConfigDocument;
using pipeline::ConfigTable;

namespace {

constexpr std::array<std::string_view, axis_count> axis_names{"x", "y", "z", "rx", "ry", "rz"};
constexpr int most_steps = 100;

Action read_action(ConfigTable& table) {
  const std::string name = table.text("action", "");
  if (const auto action = action_named(name))
    return *action;
  std::vector<std::string_view> known;
  for (const Action action : all_actions())
    known.push_back(to_string(action));
  table.complain("action is \"{}\", expected one of {}", name, fmt::join(known, ", "));
  return Action::freeze;
}

// Its index among `names`.
std::uint8_t index_among(ConfigTable& table, std::string_view key, const std::string& name,
                         const std::vector<std::string>& names) {
  const auto found = std::ranges::find(names, name);
  if (found != names.end())
    return static_cast<std::uint8_t>(found - names.begin());
  table.complain("{} is \"{}\", expected one of \"{}\", as listed under [device]", key, name,
                 fmt::join(names, "\", \""));
  return 0;
}

// A control by its index or its name.
std::uint8_t read_control(ConfigTable& table, std::string_view key,
                          const std::vector<std::string>& names) {
  if (!table.has_integer(key))
    return index_among(table, key, table.text(key, ""), names);
  return static_cast<std::uint8_t>(
      table.integer(key, 0, {0, static_cast<double>(names.size()) - 1}));
}

SwitchSet read_switches(ConfigTable& table, std::string_view key,
                        const std::vector<std::string>& names) {
  SwitchSet switches = 0;
  for (const std::string& name : table.texts(key)) {
    const SwitchSet one = SwitchSet{1} << index_among(table, key, name, names);
    if ((switches & one) != 0)
      table.complain("{} names \"{}\" twice, expected each switch once", key, name);
    switches |= one;
  }
  return switches;
}

int read_step(ConfigTable& table) {
  const int step = table.integer("step", 1, {-most_steps, most_steps});
  if (step == 0)
    table.complain("step is 0, which does nothing; expected 1, −1 or more, or no step at all");
  return step;
}

void read_switch_action(ConfigTable& table, ControlProfile& profile) {
  SwitchAction bound;
  const bool chord = table.has("with");
  if (chord)
    bound.switches = read_switches(table, "with", profile.switches);
  else
    bound.switches = SwitchSet{1} << read_control(table, "switch", profile.switches);
  const std::size_t gesture =
      table.choice("gesture", chord ? 4 : 0, {"press", "long", "double", "hold", "chord"});
  if (chord != (gesture == 4))
    table.complain(chord ? "a gesture of several switches (with) is expected to be \"chord\""
                         : "\"chord\" needs several switches: with = [..] in place of switch");
  bound.gesture = gesture == 4 ? GestureKind::press : static_cast<GestureKind>(gesture);
  bound.action = read_action(table);
  bound.step = read_step(table);
  check(table, profile, bound);
  profile.switch_actions.push_back(bound);
}

void read_knob_action(ConfigTable& table, ControlProfile& profile) {
  KnobAction bound;
  bound.knob = read_control(table, "knob", profile.knobs);
  bound.while_held = read_switches(table, "while_held", profile.switches);
  bound.action = read_action(table);
  bound.step = read_step(table);
  check(table, profile, bound);
  profile.knob_actions.push_back(bound);
}

void read_axis_action(ConfigTable& table, ControlProfile& profile) {
  constexpr double most_per_second = 1000;
  AxisAction bound;
  bound.axis =
      static_cast<std::uint8_t>(table.choice("axis", 0, {"x", "y", "z", "rx", "ry", "rz"}));
  bound.action = read_action(table);
  bound.per_second =
      table.number("per_second", bound.per_second, {-most_per_second, most_per_second});
  check(table, profile, bound);
  profile.axis_actions.push_back(bound);
}

void read_bind(ConfigTable& table, ControlProfile& profile) {
  const int named = table.has("switch") + table.has("with") + table.has("knob") + table.has("axis");
  if (named != 1) {
    table.complain("names {} controls, expected exactly one of switch, with, knob, axis", named);
    return;
  }
  if (table.has("knob"))
    read_knob_action(table, profile);
  else if (table.has("axis"))
    read_axis_action(table, profile);
  else
    read_switch_action(table, profile);
}

void read_names(ConfigTable& device, std::string_view key, std::size_t most,
                std::vector<std::string>& names) {
  if (!device.has(key))
    return;
  names = device.texts(key);
  if (names.size() > most)
    device.complain("{} names {}, expected at most {}", key, names.size(), most);
  names.resize(std::min(names.size(), most));
  for (std::size_t i = 0; i < names.size(); ++i)
    if (names[i].empty() || std::find(names.begin(), names.begin() + static_cast<std::ptrdiff_t>(i),
                                      names[i]) != names.begin() + static_cast<std::ptrdiff_t>(i))
      device.complain("{}[{}] is \"{}\", expected a name that no other has", key, i, names[i]);
}

bool is_usb_id(std::string_view text) {
  const auto hex = [](char c) { return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f'); };
  return text.size() == 9 && text[4] == ':' && std::ranges::all_of(text.substr(0, 4), hex) &&
         std::ranges::all_of(text.substr(5), hex);
}

void read_device(ConfigTable device, ControlProfile& profile) {
  profile.usb = device.texts("usb");
  for (const std::string& id : profile.usb)
    if (!is_usb_id(id))
      device.complain("usb has \"{}\", expected vendor and product as in \"05f3:00ff\", lower case",
                      id);
  read_names(device, "switches", most_switches, profile.switches);
  read_names(device, "knobs", most_knobs, profile.knobs);
  profile.switch_word = device.text("switch_word", profile.switch_word);
  profile.detents_per_turn =
      device.integer("detents_per_turn", profile.detents_per_turn, {4, 10000});
  profile.stick = device.text("stick", profile.stick);
}

void read_times(ConfigTable table, GestureTimes& times) {
  const auto read = [&](std::string_view key, hal::Duration& time, int lowest, int highest) {
    const int fallback = static_cast<int>(hal::to_ms(time));
    time = std::chrono::milliseconds{
        table.integer(key, fallback, {static_cast<double>(lowest), static_cast<double>(highest)})};
  };
  read("chord_ms", times.chord, 10, 200);
  read("long_ms", times.long_press, 300, 3000);
  read("double_ms", times.double_press, 100, 1000);
  read("hold_delay_ms", times.hold_delay, 250, 2000);
  read("hold_every_ms", times.hold_every, 30, 1000);
}

void read_menu(ConfigTable& root, ControlProfile& profile) {
  for (const std::string& name : root.texts("menu")) {
    const auto action = action_named(name);
    if (!action || !fits_menu(*action))
      root.complain("menu has \"{}\", expected actions other than next_parameter, "
                    "previous_parameter and adjust",
                    name);
    else if (std::ranges::find(profile.menu, *action) != profile.menu.end())
      root.complain("menu has \"{}\" twice, expected each action once", name);
    else
      profile.menu.push_back(*action);
  }
  if (!profile.menu.empty())
    return;
  if (root.has("menu"))
    root.complain("menu is empty, expected at least one action, or no menu at all");
  for (const Action action : all_actions())
    if (kind_of(action) == ActionKind::continuous && fits_menu(action))
      profile.menu.push_back(action);
}

hal::Result<ControlProfile> read_profile(const ConfigDocument& document) {
  ControlProfile profile;
  ConfigTable root = document.root();
  profile.name = root.text("name", "");
  if (profile.name.empty())
    root.complain("name is missing, expected what people call it, as in name = \"Foot pedal\"");
  read_menu(root, profile);
  read_device(root.table("device"), profile);
  read_times(root.table("times"), profile.times);
  for (ConfigTable& table : root.tables("bind"))
    read_bind(table, profile);
  check_whole(root, profile);
  HAL_CHECK(document.finish());
  return profile;
}

} // namespace

hal::Result<ControlProfile> ControlProfile::load(const std::filesystem::path& file) {
  return ConfigDocument::load(file).and_then(read_profile);
}

hal::Result<ControlProfile> ControlProfile::parse(std::string_view text,
                                                  const std::filesystem::path& name) {
  return ConfigDocument::parse(text, name).and_then(read_profile);
}

bool ControlProfile::reaches(Action action) const {
  const auto on_switch = [&](Action a) {
    return std::ranges::find(switch_actions, a, &SwitchAction::action) != switch_actions.end();
  };
  const auto turned = [&](Action a) {
    return std::ranges::find(knob_actions, a, &KnobAction::action) != knob_actions.end() ||
           std::ranges::find(axis_actions, a, &AxisAction::action) != axis_actions.end();
  };
  const auto bound = [&](Action a) { return on_switch(a) || turned(a); };
  // Both go through the menu; one way round is enough.
  const bool walks = bound(Action::next_parameter) || bound(Action::previous_parameter);
  if (action == Action::next_parameter || action == Action::previous_parameter)
    return walks;
  if (bound(action))
    return true;
  const bool in_menu = std::ranges::find(menu, action) != menu.end();
  const bool done_there =
      on_switch(Action::adjust) || (turned(Action::adjust) && takes_detents(kind_of(action)));
  return in_menu && done_there && (walks || menu.size() == 1);
}

std::vector<SwitchBinding> ControlProfile::switch_bindings() const {
  std::vector<SwitchBinding> bindings;
  const auto of = [&](SwitchSet set) -> SwitchBinding& {
    const auto found = std::ranges::find(bindings, set, &SwitchBinding::switches);
    return found != bindings.end() ? *found : bindings.emplace_back(SwitchBinding{.switches = set});
  };
  for (const SwitchAction& bound : switch_actions) {
    SwitchBinding& binding = of(bound.switches);
    switch (bound.gesture) {
    case GestureKind::press: binding.press = true; break;
    case GestureKind::long_press: binding.long_press = true; break;
    case GestureKind::double_press: binding.double_press = true; break;
    case GestureKind::hold: binding.hold = true; break;
    }
  }
  for (const KnobAction& bound : knob_actions)
    if (bound.while_held != 0)
      of(bound.while_held).modifies = true;
  return bindings;
}

bool fits_menu(Action action) {
  return action != Action::next_parameter && action != Action::previous_parameter &&
         action != Action::adjust;
}

std::string_view axis_name(std::uint8_t axis) {
  return axis_names[axis];
}

} // namespace octascope::ui
