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
};

// The legend of the profile's device, in the profile's order.
Legend make_legend(const ControlProfile& profile);

// The legend of the keyboard, one line per action.
Legend make_key_legend();

} // namespace octascope::ui
