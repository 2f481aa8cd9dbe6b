#include <random>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/fails_with.h"
#include "tests/support/files/fresh_seed.h"
#include "tests/support/files/mutation.h"
#include "tests/support/program/built_places.h"
#include "ui/controls/built_in_profiles.h"
#include "ui/controls/key_bindings.h"
#include "ui/controls/legend_lines.h"

namespace octascope::ui {
namespace {

using testing::HasSubstr;

ControlProfile built_in(std::string_view name) {
  auto profile = built_in_profile(name);
  EXPECT_TRUE(profile) << profile.error().message;
  return profile ? std::move(*profile) : ControlProfile{};
}

TEST(ControlProfile, every_one_that_is_built_in_loads_and_is_in_its_folder) {
  const auto folder = tests::source_folder() / "ui" / "controls" / "profiles";
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator{folder})
    files.insert(entry.path().stem().string());
  std::set<std::string> names;
  for (const BuiltInProfile& built : built_in_profiles()) {
    names.emplace(built.name);
    const auto profile = ControlProfile::parse(built.text, std::string{built.name});
    ASSERT_TRUE(profile) << profile.error().message;
    EXPECT_FALSE(profile->name.empty());
    EXPECT_TRUE(ControlProfile::load(folder / (std::string{built.name} + ".toml")));
  }
  EXPECT_EQ(names, files);
}

TEST(ControlProfile, the_default_is_of_three_switches_and_a_knob) {
  const ControlProfile profile = built_in(default_profile);
  EXPECT_EQ(profile.switches.size(), 3U);
  EXPECT_EQ(profile.knobs.size(), 1U);
  EXPECT_TRUE(profile.axis_actions.empty());
}

TEST(ControlProfile, every_device_reaches_every_action) {
  for (const BuiltInProfile& built : built_in_profiles())
    for (const Action action : all_actions())
      if (built.name != "keyboard") {
        EXPECT_TRUE(built_in(built.name).reaches(action)) << built.name << ' ' << to_string(action);
      }
}

TEST(ControlProfile, keys_reach_every_action_but_what_the_knob_turns) {
  std::set<Action> by_key;
  for (const KeyBinding& bound : key_bindings())
    by_key.insert(bound.action);
  for (const Action action : all_actions())
    if (action != Action::adjust && action != Action::previous_parameter) {
      EXPECT_TRUE(by_key.contains(action)) << to_string(action);
    }
}

TEST(ControlProfile, what_is_missing_is_not_reached) {
  ControlProfile profile = built_in(default_profile);
  std::erase_if(profile.knob_actions,
                [](const KnobAction& bound) { return bound.action == Action::adjust; });
  std::erase_if(profile.switch_actions,
                [](const SwitchAction& bound) { return bound.action == Action::adjust; });
  EXPECT_FALSE(profile.reaches(Action::window_offset));
  EXPECT_TRUE(profile.reaches(Action::layout));
  EXPECT_FALSE(built_in("keyboard").reaches(Action::freeze));
}

TEST(ControlProfile, reads_what_it_says) {
  const auto profile = ControlProfile::parse(R"(name = "Mine"
menu = ["tilt", "technique"]
[device]
usb = ["05f3:00ff"]
switches = ["a", "b"]
switch_word = "key"
knobs = ["k"]
detents_per_turn = 94
[times]
long_ms = 700
[[bind]]
switch = 1
gesture = "long"
action = "next_parameter"
step = -1
[[bind]]
with = ["a", "b"]
gesture = "chord"
action = "legend"
[[bind]]
knob = "k"
action = "adjust"
[[bind]]
knob = 0
while_held = "a"
action = "rotate"
step = 2
[[bind]]
axis = "rx"
action = "tilt"
per_second = -12.5
)",
                                             "p.toml");
  ASSERT_TRUE(profile) << profile.error().message;
  EXPECT_EQ(profile->menu, (std::vector{Action::tilt, Action::technique}));
  EXPECT_EQ(profile->times.long_press, std::chrono::milliseconds{700});
  EXPECT_EQ(profile->switch_actions[0].switches, 2U);
  EXPECT_EQ(profile->switch_actions[0].gesture, GestureKind::long_press);
  EXPECT_EQ(profile->switch_actions[0].step, -1);
  EXPECT_EQ(profile->switch_actions[1].switches, 3U);
  EXPECT_EQ(profile->knob_actions[1].while_held, 1U);
  EXPECT_EQ(profile->knob_actions[1].step, 2);
  EXPECT_EQ(profile->axis_actions[0].axis, 3);
  EXPECT_EQ(profile->axis_actions[0].per_second, -12.5);
  const Legend legend = make_legend(*profile);
  EXPECT_EQ(legend.title, "Mine");
  std::vector<std::string> controls;
  for (const LegendLine& line : legend.lines)
    controls.push_back(line.control);
  EXPECT_EQ(controls,
            (std::vector<std::string>{"K, turned", "Puck tipped forth", "B key, long press",
                                      "A + b together", "A key held, k turned"}));
  EXPECT_TRUE(legend.lines[2].back);
}

TEST(ControlProfile, refuses_with_line_and_what_was_expected) {
  EXPECT_THAT(ControlProfile::parse("", "p.toml"), tests::FailsSaying("name is missing"));
  struct Refused {
    std::string lines;
    std::vector<std::string> told;
  };
  const std::string press = "[[bind]]\nswitch = \"left\"\ngesture = \"press\"\n";
  const std::vector<Refused> all{
      {press + "action = \"fly\"\n", {"p.toml:2: [bind]", "\"fly\"", "snapshot"}},
      {press + "action = \"freeze\"\nspeed = 3\n", {"p.toml:6", "unknown key \"speed\""}},
      {"[[bind]]\nswitch = \"upper\"\naction = \"freeze\"\n",
       {"expected one of \"left\", \"centre\", \"right\""}},
      {"[[bind]]\nswitch = 3\naction = \"freeze\"\n", {"from 0 to 2"}},
      {"[[bind]]\naction = \"freeze\"\n", {"names 0 controls"}},
      {"[[bind]]\nswitch = 0\nknob = 0\naction = \"freeze\"\n", {"names 2 controls"}},
      {press + "action = \"freeze\"\n" + press + "action = \"box\"\n",
       {"p.toml:6", "left, press is bound to freeze already"}},
      {"[[bind]]\nswitch = 0\ngesture = \"long\"\naction = \"box\"\n"
       "[[bind]]\nswitch = 0\ngesture = \"hold\"\naction = \"tilt\"\n",
       {"\"hold\" begins to repeat before \"long\""}},
      {"[[bind]]\nswitch = 0\ngesture = \"hold\"\naction = \"tilt\"\n"
       "[[bind]]\nknob = 0\nwhile_held = \"left\"\naction = \"box\"\n",
       {"a knob turned meanwhile"}},
      {"[[bind]]\nswitch = 0\ngesture = \"hold\"\naction = \"snapshot\"\n", {"cannot repeat"}},
      {press + "action = \"freeze\"\nstep = -1\n", {"knows no steps"}},
      {press + "action = \"tilt\"\nstep = 0\n", {"does nothing"}},
      {"[[bind]]\nknob = 0\naction = \"snapshot\"\n", {"cannot be turned"}},
      {"[[bind]]\naxis = \"x\"\naction = \"layout\"\n", {"not continuous"}},
      {"[[bind]]\nwith = [\"left\"]\ngesture = \"chord\"\naction = \"box\"\n", {"fewer than two"}},
      {"[[bind]]\nwith = [\"left\", \"left\"]\ngesture = \"chord\"\n"
       "action = \"box\"\n",
       {"twice"}},
      {"[[bind]]\nswitch = 0\ngesture = \"chord\"\naction = \"box\"\n", {"needs several switches"}},
      {"[[bind]]\nswitch = 0\naction = \"next_parameter\"\n", {"bind adjust"}},
      {"menu = [\"tilt\", \"box\"]\n", {"cannot be gone through"}},
      {"menu = [\"adjust\"]\n", {"menu has \"adjust\""}},
      {"[device]\nusb = [\"5f3:ff\"]\n", {"\"05f3:00ff\""}},
      {"[device]\nswitches = [\"a\", \"a\"]\n", {"no other has"}},
      {"[times]\nlong_ms = 5\n", {"from 300 to 3000"}}};
  for (const auto& [lines, told] : all)
    EXPECT_THAT(ControlProfile::parse("name = \"x\"\n" + lines, "p.toml"), tests::FailsSaying(told))
        << lines;
}

TEST(ControlProfile, an_unknown_name_lists_the_known_ones) {
  EXPECT_THAT(built_in_profile("pedal"), tests::FailsSaying("\"pedal\"", "powermate"));
}

TEST(ControlProfile, mutated_ones_are_read_or_refused_with_their_name) {
  std::mt19937_64 generator{tests::fresh_seed()};
  int refused = 0;
  for (const BuiltInProfile& built : built_in_profiles())
    for (int round = 0; round < 150; ++round) {
      const auto profile =
          ControlProfile::parse(tests::mutate(std::string{built.text}, generator), "p.toml");
      if (profile) {
        EXPECT_FALSE(profile->menu.empty());
        static_cast<void>(make_legend(*profile));
        continue;
      }
      ++refused;
      ASSERT_THAT(profile.error().message, HasSubstr("p.toml")) << built.name << " " << round;
    }
  EXPECT_GT(refused, 100);
}

TEST(ControlProfile, is_found_by_device_and_number_of_switches) {
  EXPECT_EQ(built_in_profile_for("05f3:00ff", 3)->name, built_in("three_switch_pedal").name);
  EXPECT_EQ(built_in_profile_for("0c45:7404", 1)->name, built_in("pcsensor_single").name);
  EXPECT_EQ(built_in_profile_for("0c45:7404", 3)->name, built_in("pcsensor_triple").name);
  EXPECT_EQ(built_in_profile_for("1a86:e026", 3)->name, built_in("pcsensor_single").name)
      << "better than none";
  EXPECT_FALSE(built_in_profile_for("dead:beef", 3).has_value());
}

TEST(Action, names_are_found_and_unlike) {
  std::set<std::string_view> labels;
  for (const Action action : all_actions()) {
    EXPECT_EQ(action_named(to_string(action)), action);
    EXPECT_TRUE(labels.insert(label_of(action)).second) << label_of(action);
  }
  EXPECT_EQ(action_named("fly"), std::nullopt);
}

} // namespace
} // namespace octascope::ui
