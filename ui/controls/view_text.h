// What of the view is chosen, in words for people.
#pragma once

#include <string_view>

#include "ui/view/action_table.h"

namespace octascope::ui {

// What stands for an action's state: "shaded rays", "frozen". Empty for a number, whose digits say
// it, and for what has no state. Lives as long as `names`.
std::string_view words_of(const ViewState& view, const ChoiceNames& names, Action action);

} // namespace octascope::ui
