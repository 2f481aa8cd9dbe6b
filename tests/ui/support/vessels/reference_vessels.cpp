#include "tests/ui/support/vessels/reference_vessels.h"

#include <algorithm>
#include <cmath>

#include "tests/ui/support/vessels/reference_segments.h"

namespace octascope::tests {

namespace {

constexpr double looked_at_px = 2; // around an outline

void shade(ReferenceVesselPixel& pixel, const ui::VesselScene& scene, const ReferencePlace& place,
           std::uint32_t node) {
  const double inside = -place.outside_px();
  const bool hidden = inside < 0 || (pixel.covered() && pixel.depth_mm <= place.distance_mm);
  pixel.inside_px = std::max(pixel.inside_px, inside);
  pixel.to_outline_px = std::min(pixel.to_outline_px, std::abs(inside));
  if (inside >= 0)
    pixel.largest_radius_px = std::max(pixel.largest_radius_px, place.radius_px);
  if (hidden)
    return;
  pixel.depth_mm = place.distance_mm;
  pixel.node = node;
  const auto& [off_px, stretch] = place.lights[0];
  pixel.brightness = reference_light(off_px / place.radius_px, place.radius_px, stretch) *
                     double{ui::vessel_fading(scene.look, static_cast<float>(place.distance_mm))};
}

} // namespace

std::vector<ReferenceVesselPixel> reference_vessels(const ui::VesselScene& scene) {
  std::vector<ReferenceVesselPixel> pixels(static_cast<std::size_t>(scene.width * scene.height));
  for (const ReferenceSegment& segment : reference_segments(scene)) {
    const PixelRange range = pixels_around(segment, looked_at_px, scene);
    for (int y = range.top; y < range.bottom; ++y)
      for (int x = range.left; x < range.right; ++x)
        shade(pixels[static_cast<std::size_t>(y * scene.width + x)], scene,
              place_in(segment, {x + 0.5, y + 0.5}, scene), segment.node);
  }
  return pixels;
}

} // namespace octascope::tests
