// A vessel tree to be drawn: what every method of drawing it shares.
//
// One shape, whoever draws it. A segment runs from its parent's place (radius:
// segment_start_radius()) to its own. On the screen, with a and b its ends and ra and rb their
// radii in pixels (radius_mm · pixels_per_unit / distance along the view), it covers the pixels
// whose centre p lies in the rounded trapezoid
//   t = clamp(dot(p − a, b − a) / |b − a|², 0, 1),   |p − a − t(b − a)| ≤ ra + t(rb − ra);
// t is 0 where a and b coincide, and the covering radius there is the larger: seen from its end, a
// vessel is a disc. Its distance is that of the axis at t, 1 / lerp(1/za, 1/zb, t); where a segment
// is wide on the screen (least_relief_px), that of the surface of the round cone through its ends,
// so that wide vessels meet as bodies do. With d = |p − a − t(b − a)| / r, it is as bright as
// vessel_brightness(). A pixel shows the nearest segment that covers its centre, however thin: so
// what is thinner than a pixel covers, on the average, just what it should. Segments of order 5 and
// above are the exception: they are never narrower than a pixel, so that a connected vessel stays a
// connected line.
#pragma once

#include <cstdint>

#include <glm/mat4x4.hpp>

#include "pipeline/vessels/clusters.h"
#include "ui/view/camera.h"
#include "ui/view/vessel_look.h"

namespace octascope::ui {

// A line one pixel wide has a pixel in every column, or row, that it passes.
inline constexpr float least_vessel_radius_px = 0.5F;
inline constexpr unsigned least_order_kept_visible = 5;

// Of the larger end, in pixels.
inline constexpr float least_relief_px = 8;
// A surface before the near plane is cut there. To keep the nearest axis visible, the cut has this
// much of its distance from the plane.
inline constexpr float cut_relief = 0.002F;

// Of a segment's ends; `order` is that of a node that makes one.
constexpr float least_radius_px(unsigned order) {
  return order >= least_order_kept_visible ? least_vessel_radius_px : 0;
}

// Borrowed for one draw().
struct VesselScene {
  const pipeline::VesselClusters& tree;
  const Camera& camera;
  glm::mat4 world_from_tree{1}; // rigid: lengths stay
  VesselLook look;
  int width = 0; // of the picture, in pixels
  int height = 0;

  // Of what is 1 mm wide at 1 mm along the view.
  float pixels_per_unit() const {
    return 0.5F * static_cast<float>(height) / camera.tan_half_height;
  }
};

} // namespace octascope::ui
