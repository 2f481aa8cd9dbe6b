// What each control does, shown on request.
#pragma once

#include <cstdint>

#include "ui/canvas/canvas.h"
#include "ui/controls/legend_lines.h"
#include "ui/layout/layout.h"

namespace octascope::ui {

// In the layout's place for it. Controls at the left, actions at the right, or under each other
// where that is narrow; the knob's entry names `selected`. Below, what the menu goes through. What
// finds no room is on further pages, of which `page` is shown, counted round and round.
void draw_legend(Canvas& canvas, const Layout& layout, const Legend& legend, Action selected,
                 std::int64_t page);

} // namespace octascope::ui
