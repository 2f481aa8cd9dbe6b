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

// How a segment runs on the screen: the slope of its minor to its major axis, and by how much more
// than a ball's its round side rises to the eye (vessel_scene.h), 0 where that is done.
using SegmentCourse = std::uint32_t;
inline constexpr SegmentCourse course_across = 1U << 31U; // no flatter than 45 degrees
inline constexpr SegmentCourse course_body = 1U << 30U;   // not in a round end
inline constexpr unsigned course_rise_bits = 14;
inline constexpr std::uint32_t whole_rise = (1U << course_rise_bits) - 1;
inline constexpr std::uint32_t whole_slope = (1U << 14U) - 1;
inline constexpr float most_rise = 2.25F; // above √(1 + steepest_rise²)

inline constexpr SplatOutline outline_of(DepthPixel sharp) {
  return static_cast<SplatOutline>(sharp >> 20U & 0xFF0U) |
         static_cast<SplatOutline>(sharp >> 32U & outline_in_distance);
}

} // namespace octascope::ui
