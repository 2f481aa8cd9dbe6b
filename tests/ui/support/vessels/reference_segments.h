// The segments of a vessel tree on the screen (ui/vessels/scene/vessel_scene.h), in double
// precision.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "ui/vessels/scene/vessel_scene.h"

namespace octascope::tests {

// In pixels, rows from the top, centres at halves. Distances are along the view, in mm.
struct ReferenceSegment {
  glm::dvec2 a, b;
  double ra, rb;
  double za, zb;
  glm::dvec3 from, to;     // the ends in the eye's frame: right, up and along the view, mm
  double from_mm, to_mm;   // their radii
  ui::VesselColour colour; // by branch or by order, as the scene's look says
  std::uint32_t node;      // in VesselClusters::nodes

  double widest_px() const { return ra < rb ? rb : ra; }
};

// Where a place of the screen is in a segment.
struct ReferencePlace {
  double off_px;      // from the axis
  double radius_px;   // there
  double axis_mm;     // its distance
  double distance_mm; // of what is seen: the axis, or of wide segments the surface
  // Likewise, were the segment thinner or thicker by a thousandth: between them, rounding decides.
  double farthest_mm;
  double nearest_mm;
  // What its light is that of: a place so far from the axis, of a round side whose height's square is
  // so many times a ball's. Two, where rounding decides.
  struct Light {
    double off_px;
    double stretch;
  };
  std::array<Light, 2> lights{};

  double outside_px() const { return off_px - radius_px; }
};
ReferencePlace place_in(const ReferenceSegment& segment, const glm::dvec2& place,
                        const ui::VesselScene& scene);

// Of a place d radii from the axis of a vessel of that radius: the light of its round side, which
// goes over, from a pixel of width to three, from the mean of the whole width to that of the place.
double reference_light(double d, double radius_px, double stretch = 1);

// Of all segments those that are not wholly nearer than the near plane.
std::vector<ReferenceSegment> reference_segments(const ui::VesselScene& scene);

// The pixels, within the picture, whose centres are at most `margin` outside the segment.
struct PixelRange {
  int left, top, right, bottom; // the last two are not in it
};
PixelRange pixels_around(const ReferenceSegment& segment, double margin_px,
                         const ui::VesselScene& scene);

} // namespace octascope::tests
