// What each control does, shown on request.
#pragma once

#include "ui/controls/legend_lines.h"
#include "ui/hud/canvas.h"
#include "ui/layout/layout.h"

namespace octascope::ui {

// A panel at the right border, over the small pictures, so that the volume's centre stays visible.
// Controls left, actions right; `selected` is named where the knob turns it. Lines without room are
// left out, and their number is shown.
void draw_legend(Canvas& canvas, const Layout& layout, const Legend& legend, Action selected);

} // namespace octascope::ui
