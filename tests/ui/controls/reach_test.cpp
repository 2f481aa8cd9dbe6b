// How far each function is from rest: in actions of one foot and one hand. An action is a press, a
// long press, a double press, or a turn by any number of detents; a switch held meanwhile counts as
// one. Two switches at once are not counted on.
#include <bit>
#include <fstream>
#include <optional>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/support/program/built_places.h"
#include "ui/controls/built_in_profiles.h"
#include "ui/controls/legend_lines.h"
#include "ui/controls/view_controller.h"

namespace octascope::ui {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr int most_actions = 3;

// One gesture of the profile: a switch or a knob alone, or a knob while a switch is held.
struct Move {
  Action action = Action::adjust;
  std::optional<SwitchAction> on_switch;
  std::optional<KnobAction> on_knob;

  int actions() const { return on_knob && on_knob->while_held != 0 ? 2 : 1; }
};

struct Way {
  std::vector<Move> moves;

  int actions() const {
    int sum = 0;
    for (const Move& move : moves)
      sum += move.actions();
    return sum;
  }
};

std::vector<Move> moves_of(const ControlProfile& profile) {
  std::vector<Move> moves;
  for (const KnobAction& bound : profile.knob_actions)
    moves.push_back({bound.action, {}, bound});
  for (const SwitchAction& bound : profile.switch_actions)
    if (std::has_single_bit(bound.switches))
      moves.push_back({bound.action, bound, {}});
  return moves;
}

// The nearest move for an action that satisfies the rule.
template <class Rule>
std::optional<Move> nearest(const ControlProfile& profile, Action action, const Rule& rule) {
  std::optional<Move> best;
  for (const Move& move : moves_of(profile))
    if (move.action == action && rule(move) && (!best || move.actions() < best->actions()))
      best = move;
  return best;
}

// Straight, or chosen by a turn and then done.
std::optional<Way> way_to(const ControlProfile& profile, Action action) {
  const auto any = [](const Move&) { return true; };
  if (const auto straight = nearest(profile, action, any))
    return Way{{*straight}};
  const auto turned = [](const Move& move) { return move.on_knob.has_value(); };
  const auto choice = nearest(profile, Action::next_parameter, turned);
  const auto done = nearest(profile, Action::adjust, [&](const Move& move) {
    return move.on_switch || takes_detents(kind_of(action));
  });
  if (!choice || !done || std::ranges::find(profile.menu, action) == profile.menu.end())
    return std::nullopt;
  return Way{{*choice, *done}};
}

// What the legend calls a move.
std::string words_of(const ControlProfile& profile, const Move& move) {
  ControlProfile alone = profile;
  alone.axis_actions.clear();
  alone.switch_actions.clear();
  alone.knob_actions.clear();
  if (move.on_knob)
    alone.knob_actions = {*move.on_knob};
  else
    alone.switch_actions = {*move.on_switch};
  return make_legend(alone).lines.at(0).control;
}

// A foot and a hand on the device, from rest.
class Hands {
public:
  explicit Hands(const ControlProfile& profile)
      : profile_{profile}, controller_{{}, {512, 300, 80}, profile} {
    controller_.actions().set_vessels_loaded(true);
    controller_.actions().perform(Action::stereo, 1, Done::pressed, now_);
  }

  ViewActions& actions() { return controller_.actions(); }
  std::uint64_t count(Action action) { return actions().counts()[index_of(action)]; }

  void select(Action action) {
    while (controller_.state().selected != action)
      actions().perform(Action::next_parameter, 1, Done::pressed, now_);
  }

  // Turned until the function is chosen, or by a detent.
  void make(const Move& move, Action wanted) {
    if (move.on_switch) {
      const SwitchAction& bound = *move.on_switch;
      tread(bound.switches,
            bound.gesture == GestureKind::long_press ? milliseconds{700} : milliseconds{100});
      if (bound.gesture == GestureKind::double_press)
        tread(bound.switches, milliseconds{100});
      wait(seconds{1});
      return;
    }
    const KnobAction& bound = *move.on_knob;
    hold(bound.while_held, 1);
    wait(milliseconds{200});
    const int unit = std::max((profile_.detents_per_turn + 23) / 24, 1);
    const auto turn = [&] {
      wait(milliseconds{200});
      controller_.handle(hal::ControlEvent{now_, hal::ControlKind::knob, bound.knob, unit});
    };
    if (bound.action == Action::next_parameter)
      for (std::size_t i = 0; i < 2 * action_count && controller_.state().selected != wanted; ++i)
        turn();
    else
      turn();
    hold(bound.while_held, 0);
    wait(seconds{1});
  }

private:
  void hold(SwitchSet switches, int down) {
    for (std::uint8_t i = 0; i < most_switches; ++i)
      if ((switches >> i & 1U) != 0)
        controller_.handle(hal::ControlEvent{now_, hal::ControlKind::pedal_switch, i, down});
  }
  void tread(SwitchSet switches, hal::Duration held) {
    hold(switches, 1);
    wait(held);
    hold(switches, 0);
    wait(milliseconds{100});
  }
  void wait(hal::Duration time) {
    now_ += time;
    controller_.advance(now_);
  }

  ControlProfile profile_;
  hal::TimePoint now_{seconds{50}};
  ViewController controller_;
};

bool operates_menu(Action action) {
  return !fits_menu(action);
}

// Each way is walked, whatever the knob turned before, and does its function.
TEST(Reach, every_function_of_every_knob_is_within_three_actions) {
  for (const BuiltInProfile& built : built_in_profiles()) {
    const auto profile = built_in_profile(built.name);
    ASSERT_TRUE(profile);
    if (profile->knobs.empty())
      continue;
    for (const Action action : all_actions()) {
      if (operates_menu(action))
        continue;
      SCOPED_TRACE(fmt::format("{}: {}", built.name, to_string(action)));
      const auto way = way_to(*profile, action);
      ASSERT_TRUE(way);
      EXPECT_LE(way->actions(), most_actions);
      Hands hands{*profile};
      hands.select(profile->menu[action == profile->menu[0] ? 1 : 0]);
      const std::uint64_t before = hands.count(action);
      for (const Move& move : way->moves)
        hands.make(move, action);
      EXPECT_GT(hands.count(action), before);
    }
  }
}

// A foot cannot press the left and the right one of three, or all three, within 80 ms.
TEST(Reach, no_pedal_needs_more_than_neighbouring_switches_at_once) {
  for (const BuiltInProfile& built : built_in_profiles()) {
    const auto profile = built_in_profile(built.name);
    ASSERT_TRUE(profile);
    if (profile->switch_word != "pedal")
      continue;
    const auto neighbours = [](SwitchSet switches) {
      const int lowest = std::countr_zero(switches);
      return std::popcount(switches) <= 2 && switches >> lowest <= 0b11U;
    };
    for (const SwitchAction& bound : profile->switch_actions)
      EXPECT_TRUE(neighbours(bound.switches)) << built.name << ' ' << to_string(bound.action);
    for (const KnobAction& bound : profile->knob_actions)
      EXPECT_LE(std::popcount(bound.while_held), 1) << built.name;
  }
}

std::string reach_table(const ControlProfile& profile) {
  std::string table = "| function | actions | how |\n|---|---|---|\n";
  for (const Action action : all_actions()) {
    if (operates_menu(action))
      continue;
    const auto way = way_to(profile, action);
    std::string how;
    for (const Move& move : way->moves)
      how += (how.empty() ? "" : "; ") + words_of(profile, move);
    table += fmt::format("| {} | {} | {} |\n", label_of(action), way->actions(), how);
  }
  return table;
}

TEST(Reach, the_documents_table_is_that_of_the_default_profile) {
  const auto profile = built_in_profile(default_profile);
  ASSERT_TRUE(profile);
  std::ostringstream document;
  document << std::ifstream{tests::source_folder() / "docs" / "DISPLAY.md"}.rdbuf();
  const std::string table = reach_table(*profile);
  EXPECT_NE(document.str().find(table), std::string::npos)
      << "docs/DISPLAY.md is expected to have this under \"How far each function is\":\n"
      << table;
}

} // namespace
} // namespace octascope::ui
