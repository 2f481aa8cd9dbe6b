// The wire-frame box, with edges behind the volume distinguished from those in front. Pure.
#pragma once

#include <array>

#include <glm/vec2.hpp>

#include "ui/layout/layout.h"
#include "ui/view/camera.h"

namespace octascope::ui {

// On the screen, in pixels.
struct BoxEdge {
  glm::vec2 from;
  glm::vec2 to;
  bool in_front = false; // of everything inside the box; else behind it. Exact, since the box is
                         // convex.
  bool visible = false;  // false: entirely behind the eye
};

std::array<BoxEdge, 12> project_box(const Camera& camera, const glm::vec3& extents_mm,
                                    const Rect& view);

// The outline of a B-scan's plane; `share` is its place along the slow axis, 0…1. Its edges lie in
// faces of the box, so they too are entirely before or behind everything inside.
std::array<BoxEdge, 4> project_slice(const Camera& camera, const glm::vec3& extents_mm, float share,
                                     const Rect& view);

// The parts of the box's four edges along the slow axis between two such places.
std::array<BoxEdge, 4> project_slow_edges(const Camera& camera, const glm::vec3& extents_mm,
                                          float from, float to, const Rect& view);

} // namespace octascope::ui
