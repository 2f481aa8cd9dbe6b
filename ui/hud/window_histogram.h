// How often each level occurs in the volume, and the effect of the display window.
#pragma once

#include <array>

#include "ui/hud/canvas.h"
#include "ui/layout/layout.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

// Shares of the voxels, evenly over the range of levels (pipeline/volume/level_scale.h), the lowest first.
using LevelShares = std::array<float, 128>;

// A plate with the histogram, the window's opacity over it (0 below, a ramp, 1 above), and levels
// in decibels under it. Heights are square roots of shares: noise would hide tissue otherwise.
void draw_window_histogram(Canvas& canvas, const Rect& rect, const LevelShares& shares,
                           const ViewState& view, float unit);

} // namespace octascope::ui
