// What a control just did, shown on the display for a moment.
#pragma once

#include <string_view>

#include "ui/hud/canvas.h"
#include "ui/layout/layout.h"
#include "ui/view/fixed_text.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

struct ParameterEcho {
  bool visible = false;
  bool chosen = false; // the knob turns it from now on
  std::string_view name;
  FixedText<48> value;
  bool ranged = false; // has a bar
  float share = 0;     // of its range, 0…1
  bool operator==(const ParameterEcho&) const = default;
};

// `b_scans` of the shown volume. Pure.
ParameterEcho compose_echo(const ViewState& view, hal::TimePoint now, int b_scans);

// At its place in the layout, as wide as its text needs.
void draw_echo(Canvas& canvas, const Layout& layout, const ParameterEcho& echo);

} // namespace octascope::ui
