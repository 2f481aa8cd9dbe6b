// Intersects planes with the volume's box: the geometry of the view-aligned plane stack. Pure.
//
// Source: the plane stack of the OCT paper: n planes perpendicular to the view with spacing d, the
// outermost d/2 from the volume's borders; each polygon is plane ∩ box.
#pragma once

#include <array>
#include <span>

#include <glm/vec3.hpp>

#include "ui/view/camera.h"

namespace octascope::ui {

// A convex polygon of 3 to 6 corners in order around it, or empty.
struct PlanePolygon {
  std::array<glm::vec3, 6> corners;
  int count = 0;

  std::span<const glm::vec3> view() const {
    return std::span{corners}.first(static_cast<std::size_t>(count));
  }
};

// Cuts the box [−half, half] with the plane {p : p · normal = offset}, normal a unit vector.
PlanePolygon intersect_plane_box(const glm::vec3& half, const glm::vec3& normal, float offset);

// Distances of the planes from the eye along the view: first + i · spacing, i < planes. If the eye
// is inside the box, the stack begins at the near plane.
struct StackSpacing {
  float first_mm;
  float spacing_mm;
};

StackSpacing space_planes(const Camera& camera, const glm::vec3& half, int planes);

// The number of planes that keeps the spacing at or below step_mm: 2 to `most`.
int count_planes(const Camera& camera, const glm::vec3& half, float step_mm, int most);

// The length to which ViewState::opacity refers: a fixed share of the box's diagonal, so that the
// picture depends neither on the number of planes nor on the view direction.
float reference_step_mm(const glm::vec3& half);

} // namespace octascope::ui
