// The outline of what a pixel of the sharp picture shows, in twelve bits: how far it is from the
// pixel's centre to the vessel's two sides, along the row or the column, whichever the outline
// crosses more steeply. With it a second pass knows how much of the pixel, and of its neighbour
// beyond the outline, the vessel covers. Source of the idea: E. Persson, geometry buffer
// antialiasing, "Geometric antialiasing methods" (GPU Pro 3, 2012); here with both sides, for vessels as thin as a pixel.
//
// A pixel of the sharp picture is a DepthPixel with the outline's upper eight bits in the place of
// the opacity, and the lower four in the lowest bits of the distance, which change it by less than
// 2e-6 of itself.
#pragma once

#include <cstdint>

#include "ui/depth_mask/depth_image.h"
#include "ui/view/vessel_look.h"

namespace octascope::ui {

// 0: thinner than a pixel (least_raised_px), or no vessel.
using SplatOutline = std::uint32_t;
inline constexpr SplatOutline outline_sideways = 1U << 11U; // along the row, else the column
inline constexpr SplatOutline outline_oblique = 1U << 10U;  // nearer to 45 degrees than to 0
// To the side at the left or above, and below that, to the side at the right or below: in steps
// from 0 on. The last one is "in another pixel"; it begins a step past a whole pixel, since of two
// pixels neither may take the outline to be the other's.
inline constexpr unsigned outline_step_bits = 5;
inline constexpr std::uint32_t outline_beyond = (1U << outline_step_bits) - 1;
inline constexpr float outline_steps = 30; // a pixel
// Further within a vessel, both sides are in other pixels, at any angle.
inline constexpr float outline_reach_px = 1.5F;
inline constexpr SplatOutline outline_of_inside =
    outline_beyond << outline_step_bits | outline_beyond;
inline constexpr std::uint32_t outline_in_distance = 0xF;

// FragmentLook: the outline above d² (vessel_scene.h) as a share of whole_off_axis.
inline constexpr unsigned off_axis_bits = 20;
inline constexpr std::uint32_t whole_off_axis = (1U << off_axis_bits) - 1;
inline constexpr std::uint32_t look_of_thin =
    static_cast<std::uint32_t>(mean_off_axis * static_cast<float>(whole_off_axis));

inline constexpr SplatOutline outline_of(DepthPixel sharp) {
  return static_cast<SplatOutline>(sharp >> 20U & 0xFF0U) |
         static_cast<SplatOutline>(sharp >> 32U & outline_in_distance);
}

} // namespace octascope::ui
