// A sharp picture of vessels (splat_outline.h) compared with their definition (ui/vessels/scene/vessel_scene.h), segment by
// segment and pixel by pixel, in double precision.
#pragma once

#include <cstddef>

#include "ui/depth_mask/depth_image.h"
#include "ui/vessels/scene/vessel_scene.h"

namespace octascope::tests {

struct SplatCheck {
  std::size_t covered = 0; // pixels that show a vessel
  // Pixels that show what no segment gives them, in distance or colour. A segment is believed to
  // cover a centre that is up to 0.01 pixels off its edge.
  std::size_t unexplained = 0;
  // Pixels that show nothing, or something further than a segment that covers them by 0.01 pixels.
  std::size_t missed = 0;
  std::size_t sub_pixel = 0; // segments drawn with a radius below half a pixel
};

SplatCheck check_splats(const ui::VesselScene& scene, const ui::DepthImage& image);

} // namespace octascope::tests
