// The lines of the legend: what each control does.
#pragma once

#include <string>
#include <vector>

#include "ui/controls/control_profile.h"

namespace octascope::ui {

struct LegendLine {
  std::string control; // "Left pedal, long press"
  Action action = Action::freeze;
  bool back = false; // its step is negative
};

struct Legend {
  std::string title;
  std::vector<LegendLine> lines;
  std::vector<Action> menu{}; // what next_parameter goes through; empty: there is no such control
};

// For the profile's device, in the profile's order.
Legend make_legend(const ControlProfile& profile);

// "left pedal", "button 3", "left + right".
std::string words_for(const ControlProfile& profile, SwitchSet switches);

// For the keyboard, one line per action.
Legend make_key_legend();

} // namespace octascope::ui
