#include "ui/controls/profile_rules.h"

#include <algorithm>
#include <bit>
#include <string>

#include <fmt/format.h>

namespace octascope::ui {

using pipeline::ConfigTable;

namespace {

std::string names_of(const ControlProfile& profile, SwitchSet switches) {
  std::string names;
  for (std::size_t i = 0; i < profile.switches.size(); ++i)
    if ((switches >> i & 1U) != 0)
      names += (names.empty() ? "" : " + ") + profile.switches[i];
  return names;
}

std::string_view name_of(GestureKind gesture) {
  switch (gesture) {
  case GestureKind::press: return "press";
  case GestureKind::long_press: return "long";
  case GestureKind::double_press: return "double";
  case GestureKind::hold: return "hold";
  }
  return "press";
}

void complain_about_second(ConfigTable& table, std::string_view what, Action first) {
  table.complain("{} is bound to {} already; expected once, so leave one out", what,
                 to_string(first));
}

// Both would begin while the switch is down.
void check_hold(ConfigTable& table, const ControlProfile& profile, SwitchSet switches, bool holds,
                std::string_view other, bool others) {
  if (holds && others)
    table.complain(
        "{}: \"hold\" begins to repeat before {} could be told from it; expected only one of them",
        names_of(profile, switches), other);
}

const SwitchAction* find(const ControlProfile& profile, SwitchSet switches, GestureKind gesture) {
  for (const SwitchAction& bound : profile.switch_actions)
    if (bound.switches == switches && bound.gesture == gesture)
      return &bound;
  return nullptr;
}

bool modifies(const ControlProfile& profile, SwitchSet switches) {
  return std::ranges::any_of(profile.knob_actions,
                             [&](const KnobAction& bound) { return bound.while_held == switches; });
}

bool bound_somewhere(const ControlProfile& profile, Action action) {
  return std::ranges::find(profile.switch_actions, action, &SwitchAction::action) !=
             profile.switch_actions.end() ||
         std::ranges::find(profile.knob_actions, action, &KnobAction::action) !=
             profile.knob_actions.end() ||
         std::ranges::find(profile.axis_actions, action, &AxisAction::action) !=
             profile.axis_actions.end();
}

} // namespace

void check(ConfigTable& table, const ControlProfile& before, const SwitchAction& bound) {
  const std::string names = names_of(before, bound.switches);
  if (table.has("with") && std::popcount(bound.switches) < 2)
    table.complain("with names fewer than two switches, expected two or more; for one, use switch");
  if (const SwitchAction* first = find(before, bound.switches, bound.gesture))
    complain_about_second(table, fmt::format("{}, {}", names, name_of(bound.gesture)),
                          first->action);
  const bool holds = bound.gesture == GestureKind::hold;
  check_hold(table, before, bound.switches, holds, "\"long\"",
             find(before, bound.switches, GestureKind::long_press) != nullptr);
  check_hold(table, before, bound.switches, bound.gesture == GestureKind::long_press, "\"long\"",
             find(before, bound.switches, GestureKind::hold) != nullptr);
  check_hold(table, before, bound.switches, holds, "a knob turned meanwhile",
             modifies(before, bound.switches));
  if (holds && !has_direction(kind_of(bound.action)))
    table.complain(
        "{} happens once, so it cannot repeat; expected \"press\", \"long\" or \"double\"",
        to_string(bound.action));
  if (bound.step != 1 && !has_direction(kind_of(bound.action)))
    table.complain("step is {}, but {} knows no steps; expected none", bound.step,
                   to_string(bound.action));
}

void check(ConfigTable& table, const ControlProfile& before, const KnobAction& bound) {
  for (const KnobAction& other : before.knob_actions)
    if (other.knob == bound.knob && other.while_held == bound.while_held)
      complain_about_second(table, before.knobs[bound.knob], other.action);
  check_hold(table, before, bound.while_held,
             find(before, bound.while_held, GestureKind::hold) != nullptr,
             "a knob turned meanwhile", bound.while_held != 0);
  if (!takes_detents(kind_of(bound.action)))
    table.complain("{} cannot be turned; expected a switch for it, not a knob",
                   to_string(bound.action));
}

void check(ConfigTable& table, const ControlProfile& before, const AxisAction& bound) {
  for (const AxisAction& other : before.axis_actions)
    if (other.axis == bound.axis)
      complain_about_second(table, axis_name(bound.axis), other.action);
  if (kind_of(bound.action) != ActionKind::continuous)
    table.complain(
        "{} is not continuous; expected rotate, tilt, distance or another that an axis can drive",
        to_string(bound.action));
  if (bound.per_second == 0)
    table.complain("per_second is 0, which does nothing; expected a rate, as in 30");
}

void check_whole(ConfigTable& root, const ControlProfile& profile) {
  const bool walks = bound_somewhere(profile, Action::next_parameter) ||
                     bound_somewhere(profile, Action::previous_parameter);
  const bool adjusts = bound_somewhere(profile, Action::adjust);
  if (walks && !adjusts)
    root.complain("next_parameter or previous_parameter is bound, but adjust is not: what is "
                  "chosen could never be changed; bind adjust to a knob or a switch");
  if (root.has("menu") && profile.menu.size() > 1 && !walks)
    root.complain("menu cannot be gone through; bind next_parameter or previous_parameter");
}

} // namespace octascope::ui
