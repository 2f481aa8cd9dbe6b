// A vessel tree to be drawn, and the shape that every drawing method must produce.
//
// A segment runs from its parent's place (radius: segment_start_radius()) to its own. On the
// screen, with a and b its ends and ra and rb their radii in pixels (radius_mm · pixels_per_unit /
// distance along the view), it covers the pixels whose centre p lies in the rounded trapezoid
//   t = clamp(dot(p − a, b − a) / |b − a|², 0, 1),   |p − a − t(b − a)| ≤ ra + t(rb − ra);
// If a and b coincide, t is 0 and the larger radius counts: seen from its end, a vessel is a disc.
// Its distance is that of the axis at t, 1 / lerp(1/za, 1/zb, t) = z. For wide segments
// (least_relief_px), it is that of the surface of the round cone through the ends, so that wide
// vessels intersect like solids. Between these and those thinner than a pixel (least_raised_px) it
// is z / (1 + rise / pixels_per_unit), where the round side rises by
//   rise = √(r² − |p − a − t(b − a)|²) · √(1 + slope²)
// pixels; slope is the segment's along the view as seen from a, at most steepest_rise, and 0 where t
// is clamped.
// So of two segments that overlap at a joint a pixel shows the one that it is deeper within, and no
// end of one is seen on the other. Wide segments meet there in a ball that belongs to both; beyond an
// end it is set back by end_set_back, so that the other one, of whose body it is, shows it. With
// d = |p − a − t(b − a)| / r, its brightness is vessel_brightness(). Beyond a wide segment's end that
// is the further one, its sides are seen, too: there t is not clamped for d; and its ball has the
// sides' light where they meet: 1 − d² is (1 + slope²) times as much, at most 1, and it is set back
// twice. A pixel shows the nearest segment that covers its centre, however thin, so
// segments thinner than a pixel cover the right area on average. Segments of order 5 and above are
// the exception: they are never narrower than a pixel, so that a connected vessel stays a connected
// line.
#pragma once

#include <glm/mat4x4.hpp>

#include "pipeline/vessels/clusters.h"
#include "ui/view/camera.h"
#include "ui/view/vessel_look.h"

namespace octascope::ui {

// A line one pixel wide has a pixel in every column or row that it crosses.
inline constexpr float least_vessel_radius_px = 0.5F;
inline constexpr unsigned least_order_kept_visible = 5;

// From this radius at a pixel on, the round side rises: a pixel of width, less what rounding takes.
inline constexpr float least_raised_px = 0.499F;
inline constexpr float steepest_rise = 2;
// Wide ones by this share of it, where the outline on the screen is a little wider than the cone.
inline constexpr float relief_rise = 0.02F;
// A share of its distance: more than rounding does to a ball's, and less than a tenth of a pixel.
inline constexpr float end_set_back = 2e-5F;

// Of the larger end, in pixels.
inline constexpr float least_relief_px = 8;
// A surface in front of the near plane is cut there. So that the nearest axis stays visible, the
// cut keeps this fraction of the axis's distance from the plane.
inline constexpr float cut_relief = 0.002F;

// The minimum radius of a segment's ends; `order` is that of the node that makes it.
constexpr float least_radius_px(unsigned order) {
  return order >= least_order_kept_visible ? least_vessel_radius_px : 0;
}

// Borrowed for one draw().
struct VesselScene {
  const pipeline::VesselClusters& tree;
  const Camera& camera;
  glm::mat4 world_from_tree{1}; // rigid
  VesselLook look;
  int width = 0; // of the picture, in pixels
  int height = 0;

  // The size in pixels of 1 mm at 1 mm along the view.
  float pixels_per_unit() const {
    return 0.5F * static_cast<float>(height) / camera.tan_half_height;
  }
};

} // namespace octascope::ui
