// What each control does, shown on request.
#pragma once

#include "ui/controls/legend_lines.h"
#include "ui/hud/canvas.h"
#include "ui/layout/layout.h"

namespace octascope::ui {

// A panel at the right border of the picture, over the small pictures there, so that the volume's
// centre stays in sight: controls left, what they do right, `selected` named where the knob turns
// it. What would make it higher than the picture is left out, and it says how much.
void draw_legend(Canvas& canvas, const Layout& layout, const Legend& legend, Action selected);

} // namespace octascope::ui
