// What of the view is chosen, in words for people.
#pragma once

#include <string_view>

#include "ui/controls/view_actions.h"

namespace octascope::ui {

std::string_view words_for(Technique technique);
std::string_view words_for(LayoutKind layout);
std::string_view words_for(StereoMode mode);

// What stands for an action's state: "shaded rays", "frozen". Empty for a parameter, whose number
// says it, and for what has no state. Lives as long as `names`.
std::string_view words_of(const ViewState& view, const ChoiceNames& names, Action action);

} // namespace octascope::ui
