// What a control just did: shown for a moment in the place of what the knob turns.
#pragma once

#include <string_view>

#include "ui/view/action_table.h"
#include "ui/view/fixed_text.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

struct ParameterEcho {
  bool visible = false;
  bool chosen = false; // the knob has just been assigned to it
  std::string_view name;
  FixedText<48> value;
  bool ranged = false; // has a bar
  float share = 0;     // position in the range, 0…1
  bool operator==(const ParameterEcho&) const = default;
};

// `volume`: the shown one. Pure.
ParameterEcho compose_echo(const ViewState& view, hal::TimePoint now, const Geometry& volume);

} // namespace octascope::ui
