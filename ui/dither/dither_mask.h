// By what share of a step each pixel's samples are moved along its ray. Pure.
//
// Evenly cut surfaces show contour lines: the samples' shells seen against the surface. Moved rays
// show grain instead. How it looks depends on the mask: a linear one (a lattice, interleaved
// gradient noise) brings rings back wherever a surface's slope cancels the mask's; blue noise has no
// such slope, and next to nothing of it survives the average over a few pixels (soften.h).
//
// Source: R. Ulichney, "The void-and-cluster method for dither array generation", Proc. SPIE 1913
// (1993).
#pragma once

#include <array>
#include <cstddef>

namespace octascope::ui {

inline constexpr int dither_size = 32; // pixels; repeated over the picture

// [row from the bottom][column], 0…1, each value once. Made when it is first asked for, in some
// milliseconds. Any thread.
using DitherMask = std::array<float, static_cast<std::size_t>(dither_size* dither_size)>;
const DitherMask& dither_mask();

} // namespace octascope::ui
