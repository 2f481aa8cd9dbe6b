// How vessels are coloured.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "pipeline/vessels/tree.h"

namespace octascope::ui {

enum class VesselColouring : std::uint8_t {
  branch,     // RCA, LAD, LCX
  order,      // from capillaries to the main arteries
  diagnostic, // red: drawn by GL, white: by the processor
};

using VesselColour = std::array<float, 3>; // 0…1, display-referred

// By VesselBranch. They also differ in lightness, for red-green colour blindness.
inline constexpr std::array<VesselColour, pipeline::vessel_branch_count> branch_colours{{
    {0.36F, 0.76F, 0.48F}, // of no branch: not grey, as tissue is, nor a B-scan's blue or pink
    {0.93F, 0.33F, 0.24F},
    {0.98F, 0.80F, 0.42F},
    {0.42F, 0.66F, 0.95F},
}};
// By order.
inline constexpr std::array<VesselColour, pipeline::vessel_order_count> order_colours{{
    {0.38F, 0.42F, 0.80F},
    {0.36F, 0.54F, 0.84F},
    {0.34F, 0.65F, 0.82F},
    {0.38F, 0.74F, 0.74F},
    {0.50F, 0.80F, 0.62F},
    {0.66F, 0.83F, 0.50F},
    {0.82F, 0.82F, 0.42F},
    {0.94F, 0.76F, 0.38F},
    {0.97F, 0.64F, 0.34F},
    {0.96F, 0.50F, 0.32F},
    {0.93F, 0.38F, 0.32F},
    {0.90F, 0.28F, 0.34F},
}};
inline constexpr VesselColour drawn_by_gl{1, 0.12F, 0.10F};
inline constexpr VesselColour drawn_by_processor{1, 1, 1};

struct VesselLook {
  VesselColouring colouring = VesselColouring::branch;
  // Depth cue: the share of brightness lost from the near to the far end of what is drawn; 0: none.
  // Near and far are distances along the view, in mm.
  float depth_cue = 0.55F;
  float cue_near_mm = 0;
  float cue_far_mm = 1;
  bool occluded = false; // what lies close behind others is shaded (ui/vessels/splatter)

  bool operator==(const VesselLook&) const = default;
};

// Light from the eye on a round vessel. `d`: distance from the axis in radii (0…1). A vessel no
// wider than a pixel shows the mean of its width, π / 4 of what faces the eye, since all of it lies
// within a pixel; from three pixels on, the light at the pixel's centre; between them, a mixture.
inline constexpr float vessel_ambient = 0.35F;
inline constexpr float mean_off_axis = 0.38315F; // the d² that has the mean light: 1 − (π / 4)²
inline constexpr float least_shaded_px = 0.5F;   // of radius; the mixture ends a pixel above
inline float vessel_brightness(float d, float radius_px) {
  const float share = std::fmin(std::fmax(radius_px - least_shaded_px, 0.0F), 1.0F);
  const float off_axis = mean_off_axis + share * (d * d - mean_off_axis);
  return vessel_ambient + (1 - vessel_ambient) * std::sqrt(std::fmax(0.0F, 1 - off_axis));
}

// The share of its light that what is wholly surrounded by nearer vessels loses.
inline constexpr float vessel_occlusion = 0.6F;

// The brightness that remains at a distance along the view.
inline float vessel_fading(const VesselLook& look, float depth_mm) {
  const float share = (depth_mm - look.cue_near_mm) / (look.cue_far_mm - look.cue_near_mm);
  return 1 - look.depth_cue * std::fmin(std::fmax(share, 0.0F), 1.0F);
}

} // namespace octascope::ui
