// A segment's outline on the screen, computed by the processor.
//
// Repeats shaders/vessels/vessel_nodes.glsl and vessel_segment.glsl step by step, in single precision and
// without fused multiply-add, so that a GL that rounds each step (IEEE 754), such as Mesa's
// software renderer, gets identical numbers. GPUs that fuse products and sums, as most do, differ
// in the last bits. Files that include this header are compiled with -ffp-contract=off.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "ui/vessels/scene/vessel_frame.h"

namespace octascope::ui {

// Homogeneous: pixels · distance, distance, radius in pixels · distance; the shader's place_of.
struct PlacedNode {
  float across, up, along, radius;
};

// In the order of the vertex buffers: v_axis and v_shape of shaders/vessels/vessel_quad.glsl.
struct SegmentOutline {
  float start_x, start_y; // pixels, rows from the bottom
  float ahead_x, ahead_y; // from there to the end
  float radius, radius_change;
  float inverse_distance, inverse_distance_change; // of the axis, 1 / mm

  bool operator==(const SegmentOutline&) const = default;
};

inline float power_of_two(float x) {
  const float whole = std::floor(x + 0.5F);
  const float f = x - whole;
  float p = 0.0013333558F;
  p = p * f + 0.0096181291F;
  p = p * f + 0.0555041087F;
  p = p * f + 0.2402265070F;
  p = p * f + 0.6931471806F;
  p = p * f + 1.0F;
  return p * std::bit_cast<float>((static_cast<std::int32_t>(whole) + 127) << 23);
}

inline PlacedNode place_node(const PlacedCluster& c, pipeline::PackedNode node) {
  const auto x = static_cast<float>(node.x());
  const auto y = static_cast<float>(node.y());
  const auto z = static_cast<float>(node.z());
  const auto row = [&](const std::array<float, 4>& r) {
    return r[0] + r[1] * x + r[2] * y + r[3] * z;
  };
  return {row(c.across), row(c.up), row(c.along),
          c.smallest_radius * power_of_two(c.log2_radius_step * static_cast<float>(node.radius()))};
}

// The point on the near plane between `hidden`, which is nearer, and `seen`.
inline PlacedNode cut_near(const PlacedNode& hidden, const PlacedNode& seen, float near_mm) {
  const float share = (near_mm - hidden.along) * (1.0F / (seen.along - hidden.along));
  return {hidden.across + (seen.across - hidden.across) * share,
          hidden.up + (seen.up - hidden.up) * share,
          hidden.along + (seen.along - hidden.along) * share,
          hidden.radius + (seen.radius - hidden.radius) * share};
}

// Gives the parent's end the radius at which the segment starts, and cuts the segment at the near
// plane. False if nothing remains.
inline bool make_segment(PlacedNode& a, PlacedNode& b, float near_mm) {
  a.radius = pipeline::segment_start_radius(a.radius, b.radius);
  if (a.along < near_mm && b.along < near_mm)
    return false;
  if (a.along < near_mm)
    a = cut_near(a, b, near_mm);
  else if (b.along < near_mm)
    b = cut_near(b, a, near_mm);
  return true;
}

// Enforces a minimum radius in pixels. Only beyond the near plane.
inline void thicken(PlacedNode& node, float least_px) {
  node.radius = std::max(node.radius, least_px * node.along);
}

// Projects the segment from the parent's to the node's place; `least_px` is the node's
// least_radius_px(). False if nothing lies beyond the near plane.
inline bool project_segment(PlacedNode a, PlacedNode b, float near_mm, float least_px,
                            SegmentOutline& outline) {
  if (!make_segment(a, b, near_mm))
    return false;
  const float inverse_a = 1.0F / a.along;
  const float inverse_b = 1.0F / b.along;
  const float start_x = a.across * inverse_a;
  const float start_y = a.up * inverse_a;
  const float ahead_x = b.across * inverse_b - start_x;
  const float ahead_y = b.up * inverse_b - start_y;
  const float radius_a = std::max(a.radius * inverse_a, least_px);
  const float radius_b = std::max(b.radius * inverse_b, least_px);
  outline = {start_x,   start_y,
             ahead_x,   ahead_y,
             radius_a,  radius_b - radius_a,
             inverse_a, inverse_b - inverse_a};
  if (ahead_x * ahead_x + ahead_y * ahead_y < 1e-8F) { // seen from its end
    outline.ahead_x = 0;
    outline.ahead_y = 0;
    outline.radius = std::max(radius_a, radius_b);
    outline.radius_change = 0;
  }
  return true;
}

} // namespace octascope::ui
