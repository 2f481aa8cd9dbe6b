// The shape of ui/vessels/scene/vessel_scene.h in double precision, pixel by pixel, with nothing
// left out.
#pragma once

#include <vector>

#include "ui/vessels/scene/vessel_scene.h"

namespace octascope::tests {

struct ReferenceVesselPixel {
  double depth_mm = 0;          // of the axis, along the view
  double brightness = 0;        // with the depth cue, 0…1
  double largest_radius_px = 0; // of all that cover it
  std::uint32_t node = 0;       // whose segment it is, in VesselClusters::nodes
  // How far the pixel's centre is inside an outline, at most, in pixels; negative outside all.
  double inside_px = -1e9;
  // How far it is from the nearest outline, on either side: near 0, rounding decides what is seen.
  double to_outline_px = 1e9;

  bool covered() const { return inside_px >= 0; }
};

// Rows from the top.
std::vector<ReferenceVesselPixel> reference_vessels(const ui::VesselScene& scene);

} // namespace octascope::tests
