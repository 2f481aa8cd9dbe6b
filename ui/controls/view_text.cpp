#include "ui/controls/view_text.h"

namespace octascope::ui {

namespace {

// Keeping and undoing the vessels' place have no value of their own; what they would do is said.
std::string_view words_without_value(const ViewState& view, Action action) {
  if (action == Action::keep_registration || action == Action::reset_registration)
    return view.vessel_nudge.any() ? "turn right to do it" : "not moved";
  return {};
}

} // namespace

std::string_view words_of(const ViewState& view, const ChoiceNames& names, Action action) {
  return std::visit(Overloaded{
                        [&](const NoValue&) { return words_without_value(view, action); },
                        [](const Number&) { return std::string_view{}; },
                        [&](const Flag& v) { return view.*v.flag ? v.on : v.off; },
                        [&](const Choice& v) { return v.values[v.of(view)].words; },
                        [&](const NamedChoice& v) {
                          return std::string_view{
                              (names.*v.names)[static_cast<std::size_t>(view.*v.index)]};
                        },
                    },
                    row_of(action).value);
}

} // namespace octascope::ui
