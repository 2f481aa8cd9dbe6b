// The wire-frame box, with the edges behind the volume told from those before it. Pure.
#pragma once

#include <array>

#include <glm/vec2.hpp>

#include "ui/camera.h"
#include "ui/layout.h"

namespace octascope::ui {

// On the screen, in pixels.
struct BoxEdge {
  glm::vec2 from;
  glm::vec2 to;
  bool in_front = false; // of everything inside the box; else behind it. Exact, the box is convex.
  bool visible = false;  // false: wholly behind the eye
};

std::array<BoxEdge, 12> project_box(const Camera& camera, const glm::vec3& extents_mm,
                                    const Rect& view);

} // namespace octascope::ui
