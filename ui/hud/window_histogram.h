// The histogram of the volume's levels, with the display window.
#pragma once

#include <array>

#include "ui/canvas/canvas.h"
#include "ui/layout/layout.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

// Shares of the voxels, lowest levels first, in equal bins (pipeline/volume/level_scale.h).
using LevelShares = std::array<float, 128>;

// A plate with the histogram, the window's opacity curve over it (0 below, a ramp, 1 above) and the
// levels in decibels under it. Heights are square roots of shares: noise would dwarf tissue.
void draw_window_histogram(Canvas& canvas, const Rect& rect, const LevelShares& shares,
                           const ViewState& view, float unit);

} // namespace octascope::ui
