// The wire-frame box, with the edges behind the volume separated from those in front. Pure.
#pragma once

#include <array>
#include <cstdint>

#include <glm/vec2.hpp>

#include "ui/layout/layout.h"
#include "ui/view/camera.h"

namespace octascope::ui {

// In screen pixels.
struct BoxEdge {
  glm::vec2 from;
  glm::vec2 to;
  bool in_front = false; // of everything inside the box; else behind it. Exact, the box is convex.
  bool visible = false;  // false: entirely behind the eye
};

std::array<BoxEdge, 12> project_box(const Camera& camera, const glm::vec3& extents_mm,
                                    const Rect& view);

// The outline of a B-scan's plane; `share` is its position along the axis that it is across, 0…1.
// Its lines lie in faces of the box, so they too are entirely in front of or behind everything inside.
enum class SliceAcross : std::uint8_t { slow, fast }; // a B-scan, a crossed one
std::array<BoxEdge, 4> project_slice(const Camera& camera, const glm::vec3& extents_mm,
                                     SliceAcross across, float share, const Rect& view);

// The parts of the box's four slow-axis edges between two such positions.
std::array<BoxEdge, 4> project_slow_edges(const Camera& camera, const glm::vec3& extents_mm,
                                          float from, float to, const Rect& view);

} // namespace octascope::ui
