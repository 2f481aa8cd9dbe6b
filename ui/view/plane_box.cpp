#include "ui/view/plane_box.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace octascope::ui {

namespace {

constexpr float reference_steps_per_diagonal = 192;

glm::vec3 box_corner(const glm::vec3& half, unsigned index) {
  return {(index & 1U) != 0 ? half.x : -half.x, (index & 2U) != 0 ? half.y : -half.y,
          (index & 4U) != 0 ? half.z : -half.z};
}

// Grows with the angle of (x, y), from −2 to 2, without trigonometry.
float pseudo_angle(float x, float y) {
  const float length = std::abs(x) + std::abs(y);
  if (length <= 0)
    return 0;
  const float p = x / length;
  return y < 0 ? p - 1 : 1 - p;
}

void sort_around_centre(PlanePolygon& polygon, const glm::vec3& normal) {
  const glm::vec3 helper = std::abs(normal.y) < 0.9F ? glm::vec3{0, 1, 0} : glm::vec3{1, 0, 0};
  const glm::vec3 u = glm::normalize(glm::cross(helper, normal));
  const glm::vec3 v = glm::cross(normal, u);
  glm::vec3 centre{0};
  for (const glm::vec3& corner : polygon.view())
    centre += corner;
  centre /= static_cast<float>(polygon.count);

  std::array<float, 6> angles{};
  for (int i = 0; i < polygon.count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const glm::vec3 corner = polygon.corners[at];
    const float angle = pseudo_angle(glm::dot(corner - centre, u), glm::dot(corner - centre, v));
    std::size_t place = at;
    for (; place > 0 && angles[place - 1] > angle; --place) {
      angles[place] = angles[place - 1];
      polygon.corners[place] = polygon.corners[place - 1];
    }
    angles[place] = angle;
    polygon.corners[place] = corner;
  }
}

// What the stack fills, as distances from the eye along the view.
struct Stretch {
  float nearest_mm;
  float length_mm;
};

Stretch stretch_along_view(const Camera& camera, const glm::vec3& half) {
  // Half of the box's extent along the view, for a box around the origin.
  const float reach = glm::dot(glm::abs(camera.forward), half);
  const float centre = camera.depth_of(glm::vec3{0});
  const float nearest = std::max(centre - reach, camera.near_mm);
  return {nearest, centre + reach - nearest};
}

} // namespace

PlanePolygon intersect_plane_box(const glm::vec3& half, const glm::vec3& normal, float offset) {
  std::array<float, 8> side{};
  for (unsigned i = 0; i < 8; ++i)
    side[i] = glm::dot(box_corner(half, i), normal) - offset;

  PlanePolygon polygon;
  for (unsigned from = 0; from < 8; ++from)
    for (unsigned axis = 1; axis <= 4; axis *= 2) {
      const unsigned to = from | axis;
      // One end counts as inside and the other does not: a corner that lies on the plane is then
      // met by an even number of edges, and never more than six edges cross.
      if (to == from || (side[from] < 0) == (side[to] < 0))
        continue;
      const float t = side[from] / (side[from] - side[to]);
      const glm::vec3 a = box_corner(half, from);
      polygon.corners[static_cast<std::size_t>(polygon.count++)] =
          a + t * (box_corner(half, to) - a);
    }
  if (polygon.count > 0)
    sort_around_centre(polygon, normal);
  return polygon;
}

StackSpacing space_planes(const Camera& camera, const glm::vec3& half, int planes) {
  const Stretch stretch = stretch_along_view(camera, half);
  const float spacing = stretch.length_mm / static_cast<float>(planes);
  return {stretch.nearest_mm + spacing / 2, spacing};
}

int count_planes(const Camera& camera, const glm::vec3& half, float step_mm, int most) {
  // A hair more than the quotient: a step that fits exactly is not rounded to one plane more.
  const float asked = std::ceil(stretch_along_view(camera, half).length_mm / step_mm - 1e-3F);
  return static_cast<int>(std::clamp(asked, 2.0F, static_cast<float>(most)));
}

float reference_step_mm(const glm::vec3& half) {
  return 2 * glm::length(half) / reference_steps_per_diagonal;
}

} // namespace octascope::ui
