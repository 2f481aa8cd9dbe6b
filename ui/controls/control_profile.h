// What each pedal, knob and axis of a device does, read from a TOML file.
//
//   name = "Three-switch pedal and knob"       # for people
//   menu = ["window_offset", "tilt"]           # what next_parameter goes through; else all that is
//                                              # continuous
//   [device]
//   usb = ["05f3:00ff"]                        # which devices it is made for: vendor:product
//   switches = ["left", "centre", "right"]     # names of switches 0, 1, 2, …; this is the default
//   switch_word = "pedal"                      # what a switch is called: "Left pedal"
//   knobs = ["knob"]                           # likewise
//   detents_per_turn = 24
//   stick = "puck"                             # what the axes belong to
//   [times]                                    # in ms; these are the defaults
//   chord_ms = 80
//   long_ms = 600
//   double_ms = 300
//   hold_delay_ms = 400
//   hold_every_ms = 100
//
//   [[bind]]                                   # exactly one of switch, with, knob, axis
//   switch = "left"                            # a name or an index
//   gesture = "long"                           # press, long, double or hold (repeats while held)
//   action = "technique"                       # ui/view/action_table.cpp
//   step = -1                                  # so many detents, or back; else 1
//   [[bind]]
//   with = ["left", "right"]                   # down together
//   gesture = "chord"
//   action = "legend"
//   [[bind]]
//   knob = 0                                   # a name or an index
//   while_held = "left"                        # or a list; else: with no such switch held
//   action = "rotate"
//   [[bind]]
//   axis = "rz"                                # x y z rx ry rz
//   action = "rotate"
//   per_second = 30                            # detents at full deflection; negative: the other way
//
// Strict: unknown keys, switches and actions are refused, and so are bindings that contradict each
// other or could never act.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "hal/result.h"
#include "ui/controls/gesture_recogniser.h"
#include "ui/view/action.h"

namespace octascope::ui {

inline constexpr int most_knobs = 8;
inline constexpr int axis_count = 6;

struct SwitchAction {
  SwitchSet switches = 0; // several: a chord
  GestureKind gesture = GestureKind::press;
  Action action = Action::freeze;
  int step = 1;
};

struct KnobAction {
  std::uint8_t knob = 0;
  SwitchSet while_held = 0;
  Action action = Action::adjust;
  int step = 1;
};

struct AxisAction {
  std::uint8_t axis = 0;
  Action action = Action::rotate;
  double per_second = 30;
};

struct ControlProfile {
  std::string name;
  std::vector<std::string> usb;
  std::vector<std::string> switches{"left", "centre", "right"};
  std::string switch_word;
  std::vector<std::string> knobs{"knob"};
  int detents_per_turn = 24;
  std::string stick = "puck";
  GestureTimes times;
  std::vector<Action> menu; // never empty
  std::vector<SwitchAction> switch_actions;
  std::vector<KnobAction> knob_actions;
  std::vector<AxisAction> axis_actions;

  static hal::Result<ControlProfile> load(const std::filesystem::path& file);
  static hal::Result<ControlProfile> parse(std::string_view text,
                                           const std::filesystem::path& name);

  // Whether the device can do the action: it is bound to a control, or can be selected from the
  // menu and then performed.
  bool reaches(Action action) const;

  // The gestures that the recogniser must tell apart.
  std::vector<SwitchBinding> switch_bindings() const;
};

// Whether a menu may hold the action: all but those that operate the menu.
bool fits_menu(Action action);

// "x" … "rz".
std::string_view axis_name(std::uint8_t axis);

} // namespace octascope::ui
