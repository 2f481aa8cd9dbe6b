// Shows for a moment what a control just did.
#pragma once

#include <string_view>

#include "ui/hud/canvas.h"
#include "ui/layout/layout.h"
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

// At the bottom of its place in the layout, as wide as its text.
void draw_echo(Canvas& canvas, const Layout& layout, const ParameterEcho& echo);

} // namespace octascope::ui
