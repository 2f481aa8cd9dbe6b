#include <random>
#include <set>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/files/fresh_seed.h"
#include "tests/support/files/mutation.h"
#include "tests/support/program/built_places.h"
#include "ui/controls/built_in_profiles.h"
#include "ui/controls/key_bindings.h"
#include "ui/controls/legend_lines.h"

namespace octascope::ui {
namespace {

using testing::AllOf;
using testing::HasSubstr;

ControlProfile built_in(std::string_view name) {
  auto profile = built_in_profile(name);
  EXPECT_TRUE(profile) << profile.error().message;
  return profile ? std::move(*profile) : ControlProfile{};
}

// The message with which a profile with these lines is refused.
std::string refusal(const std::string& lines, const std::string& head = "name = \"x\"\n") {
  const auto profile = ControlProfile::parse(head + lines, "p.toml");
  return profile ? "it is taken" : profile.error().message;
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

TEST(ControlProfile, three_switches_and_a_knob_reach_every_action) {
  const ControlProfile profile = built_in(default_profile);
  EXPECT_EQ(profile.switches.size(), 3U);
  EXPECT_EQ(profile.knobs.size(), 1U);
  EXPECT_TRUE(profile.axis_actions.empty());
  for (const Action action : all_actions())
    EXPECT_TRUE(profile.reaches(action)) << to_string(action);
}

class EveryProfile : public testing::TestWithParam<std::string_view> {};

TEST_P(EveryProfile, reaches_every_action) {
  const ControlProfile profile = built_in(GetParam());
  for (const Action action : all_actions())
    EXPECT_TRUE(profile.reaches(action)) << to_string(action);
}

INSTANTIATE_TEST_SUITE_P(Devices, EveryProfile,
                         testing::Values("three_switch_pedal", "philips_pedal", "pcsensor_single",
                                         "pcsensor_triple", "powermate", "shuttle_xpress",
                                         "shuttle_pro", "space_mouse", "surface_dial"),
                         [](const auto& test) { return std::string{test.param}; });

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
  EXPECT_FALSE(profile.reaches(Action::window_offset));
  EXPECT_TRUE(profile.reaches(Action::technique));
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
  const std::string press = "[[bind]]\nswitch = \"left\"\ngesture = \"press\"\n";
  EXPECT_THAT(refusal("", ""), HasSubstr("name is missing"));
  EXPECT_THAT(refusal(press + "action = \"fly\"\n"),
              AllOf(HasSubstr("p.toml:2: [bind]"), HasSubstr("\"fly\""), HasSubstr("snapshot")));
  EXPECT_THAT(refusal(press + "action = \"freeze\"\nspeed = 3\n"),
              AllOf(HasSubstr("p.toml:6"), HasSubstr("unknown key \"speed\"")));
  EXPECT_THAT(refusal("[[bind]]\nswitch = \"upper\"\naction = \"freeze\"\n"),
              HasSubstr("expected one of \"left\", \"centre\", \"right\""));
  EXPECT_THAT(refusal("[[bind]]\nswitch = 3\naction = \"freeze\"\n"), HasSubstr("from 0 to 2"));
  EXPECT_THAT(refusal("[[bind]]\naction = \"freeze\"\n"), HasSubstr("names 0 controls"));
  EXPECT_THAT(refusal("[[bind]]\nswitch = 0\nknob = 0\naction = \"freeze\"\n"),
              HasSubstr("names 2 controls"));
  EXPECT_THAT(refusal(press + "action = \"freeze\"\n" + press + "action = \"box\"\n"),
              AllOf(HasSubstr("p.toml:6"), HasSubstr("left, press is bound to freeze already")));
  EXPECT_THAT(refusal("[[bind]]\nswitch = 0\ngesture = \"long\"\naction = \"box\"\n"
                      "[[bind]]\nswitch = 0\ngesture = \"hold\"\naction = \"tilt\"\n"),
              HasSubstr("\"hold\" begins to repeat before \"long\""));
  EXPECT_THAT(refusal("[[bind]]\nswitch = 0\ngesture = \"hold\"\naction = \"tilt\"\n"
                      "[[bind]]\nknob = 0\nwhile_held = \"left\"\naction = \"box\"\n"),
              HasSubstr("a knob turned meanwhile"));
  EXPECT_THAT(refusal("[[bind]]\nswitch = 0\ngesture = \"hold\"\naction = \"snapshot\"\n"),
              HasSubstr("cannot repeat"));
  EXPECT_THAT(refusal(press + "action = \"freeze\"\nstep = -1\n"), HasSubstr("knows no steps"));
  EXPECT_THAT(refusal(press + "action = \"tilt\"\nstep = 0\n"), HasSubstr("does nothing"));
  EXPECT_THAT(refusal("[[bind]]\nknob = 0\naction = \"snapshot\"\n"),
              HasSubstr("cannot be turned"));
  EXPECT_THAT(refusal("[[bind]]\naxis = \"x\"\naction = \"layout\"\n"),
              HasSubstr("not continuous"));
  EXPECT_THAT(refusal("[[bind]]\nwith = [\"left\"]\ngesture = \"chord\"\naction = \"box\"\n"),
              HasSubstr("fewer than two"));
  EXPECT_THAT(refusal("[[bind]]\nwith = [\"left\", \"left\"]\ngesture = \"chord\"\n"
                      "action = \"box\"\n"),
              HasSubstr("twice"));
  EXPECT_THAT(refusal("[[bind]]\nswitch = 0\ngesture = \"chord\"\naction = \"box\"\n"),
              HasSubstr("needs several switches"));
  EXPECT_THAT(refusal("[[bind]]\nswitch = 0\naction = \"next_parameter\"\n"),
              HasSubstr("bind adjust"));
  EXPECT_THAT(refusal("menu = [\"tilt\", \"box\"]\n"), HasSubstr("cannot be gone through"));
  EXPECT_THAT(refusal("menu = [\"adjust\"]\n"), HasSubstr("menu has \"adjust\""));
  EXPECT_THAT(refusal("[device]\nusb = [\"5f3:ff\"]\n"), HasSubstr("\"05f3:00ff\""));
  EXPECT_THAT(refusal("[device]\nswitches = [\"a\", \"a\"]\n"), HasSubstr("no other has"));
  EXPECT_THAT(refusal("[times]\nlong_ms = 5\n"), HasSubstr("from 300 to 3000"));
}

TEST(ControlProfile, an_unknown_name_lists_the_known_ones) {
  const auto profile = built_in_profile("pedal");
  ASSERT_FALSE(profile);
  EXPECT_THAT(profile.error().message, AllOf(HasSubstr("\"pedal\""), HasSubstr("powermate")));
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
