#include "ui/view/view_state.h"

#include <algorithm>

#include "ui/view/action_table.h"

namespace octascope::ui {

ViewState ViewState::clamped() const {
  ViewState v = *this;
  for (const ActionRow& row : action_table())
    if (const Number* number = std::get_if<Number>(&row.value))
      number->set(v, number->of(v));
  return v;
}

bool same_sight(const ViewState& a, const ViewState& b) {
  const auto same = [&](const ActionRow& row) {
    return !row.has(trait::drawn) ||
           std::visit([&](const auto& value) { return value.same(a, b); }, row.value);
  };
  const bool same_cut = (a.cut == CutShape::none || a.b_scan == b.b_scan) &&
                        (a.cut != CutShape::corner || a.a_scan == b.a_scan);
  return same_cut && std::ranges::all_of(action_table(), same);
}

} // namespace octascope::ui
