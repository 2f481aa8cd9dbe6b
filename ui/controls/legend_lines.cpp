#include "ui/controls/legend_lines.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>

#include <fmt/format.h>

#include "ui/controls/key_bindings.h"

namespace octascope::ui {

namespace {

constexpr std::array<std::string_view, axis_count> motions{
    "left, right", "forth, back", "up, down", "tipped forth", "tipped sideways", "twisted"};

std::string capitalised(std::string words) {
  if (!words.empty())
    words[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(words[0])));
  return words;
}

std::string_view words_for(GestureKind gesture) {
  switch (gesture) {
  case GestureKind::press: return "press";
  case GestureKind::long_press: return "long press";
  case GestureKind::double_press: return "double press";
  case GestureKind::hold: return "press or hold";
  }
  return "press";
}

std::string words_for(const ControlProfile& profile, const SwitchAction& bound) {
  const std::string switches = words_for(profile, bound.switches);
  return capitalised(std::has_single_bit(bound.switches)
                         ? fmt::format("{}, {}", switches, words_for(bound.gesture))
                         : fmt::format("{} together", switches));
}

std::string words_for(const ControlProfile& profile, const KnobAction& bound) {
  const std::string& knob = profile.knobs[bound.knob];
  return capitalised(
      bound.while_held == 0
          ? fmt::format("{}, turned", knob)
          : fmt::format("{} held, {} turned", words_for(profile, bound.while_held), knob));
}

} // namespace

Legend make_legend(const ControlProfile& profile) {
  Legend legend{profile.name, {}};
  for (const KnobAction& bound : profile.knob_actions)
    if (bound.while_held == 0)
      legend.lines.push_back({words_for(profile, bound), bound.action, bound.step < 0});
  for (const AxisAction& bound : profile.axis_actions)
    legend.lines.push_back({capitalised(fmt::format("{} {}", profile.stick, motions[bound.axis])),
                            bound.action, false});
  for (const SwitchAction& bound : profile.switch_actions)
    legend.lines.push_back({words_for(profile, bound), bound.action, bound.step < 0});
  for (const KnobAction& bound : profile.knob_actions)
    if (bound.while_held != 0)
      legend.lines.push_back({words_for(profile, bound), bound.action, bound.step < 0});
  const auto chooses = [](const LegendLine& line) {
    return line.action == Action::next_parameter || line.action == Action::previous_parameter;
  };
  if (std::ranges::any_of(legend.lines, chooses))
    legend.menu = profile.menu;
  return legend;
}

std::string words_for(const ControlProfile& profile, SwitchSet switches) {
  std::string names;
  for (std::size_t i = 0; i < profile.switches.size(); ++i)
    if ((switches >> i & 1U) != 0)
      names += (names.empty() ? "" : " + ") + profile.switches[i];
  if (profile.switch_word.empty() || !std::has_single_bit(switches))
    return names;
  const bool numbered = std::isdigit(static_cast<unsigned char>(names[0])) != 0;
  return numbered ? fmt::format("{} {}", profile.switch_word, names)
                  : fmt::format("{} {}", names, profile.switch_word);
}

Legend make_key_legend() {
  Legend legend{"Keyboard", {}};
  for (const KeyBinding& bound : key_bindings()) {
    const std::string name = key_name(bound.key);
    if (!legend.lines.empty() && legend.lines.back().action == bound.action)
      legend.lines.back().control += "  " + name;
    else
      legend.lines.push_back({name, bound.action, false});
    if (bound.shifted != bound.step)
      legend.lines.back().control += bound.shifted > bound.step ? ", shift: up" : ", shift: back";
  }
  for (LegendLine& line : legend.lines)
    line.control = capitalised(line.control);
  return legend;
}

} // namespace octascope::ui
