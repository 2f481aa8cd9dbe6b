// Values of the view as text, as on the display.
#pragma once

#include <string_view>

#include "ui/view/action_table.h"

namespace octascope::ui {

// The state of an action's value: "shaded rays", "frozen". Empty for numbers, which Number::words
// formats, and for actions without a state. Valid as long as `names`.
std::string_view words_of(const ViewState& view, const ChoiceNames& names, Action action);

} // namespace octascope::ui
