#include "ui/layout/box_edges.h"

#include <glm/geometric.hpp>

namespace octascope::ui {

namespace {

// Whether the eye is outside of the face at `sign` · half on that axis, and so sees it.
bool sees_face(const Camera& camera, const glm::vec3& half, int axis, float sign) {
  return camera.eye[axis] * sign > half[axis];
}

glm::vec2 to_pixels(const Camera& camera, const glm::vec3& point, const Rect& view) {
  const glm::vec2 p = camera.project(point) * static_cast<float>(view.height);
  return {static_cast<float>(view.x) + static_cast<float>(view.width) / 2 + p.x,
          static_cast<float>(view.y) + static_cast<float>(view.height) / 2 + p.y};
}

BoxEdge project_edge(const Camera& camera, glm::vec3 a, glm::vec3 b, const Rect& view) {
  const float depth_a = camera.depth_of(a);
  const float depth_b = camera.depth_of(b);
  BoxEdge edge;
  if (depth_a < camera.near_mm && depth_b < camera.near_mm)
    return edge;
  const float t = (camera.near_mm - depth_a) / (depth_b - depth_a);
  if (depth_a < camera.near_mm)
    a += t * (b - a);
  else if (depth_b < camera.near_mm)
    b = a + t * (b - a);
  edge.from = to_pixels(camera, a, view);
  edge.to = to_pixels(camera, b, view);
  edge.visible = true;
  return edge;
}

} // namespace

std::array<BoxEdge, 12> project_box(const Camera& camera, const glm::vec3& extents_mm,
                                    const Rect& view) {
  const glm::vec3 half = extents_mm / 2.0F;
  std::array<BoxEdge, 12> edges;
  std::size_t next = 0;
  for (int axis = 0; axis < 3; ++axis)
    for (int which = 0; which < 4; ++which) {
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      const float sign_u = (which & 1) != 0 ? 1.0F : -1.0F;
      const float sign_v = (which & 2) != 0 ? 1.0F : -1.0F;
      glm::vec3 from;
      from[axis] = -half[axis];
      from[u] = sign_u * half[u];
      from[v] = sign_v * half[v];
      glm::vec3 to = from;
      to[axis] = half[axis];
      BoxEdge edge = project_edge(camera, from, to, view);
      edge.in_front = sees_face(camera, half, u, sign_u) || sees_face(camera, half, v, sign_v);
      edges[next++] = edge;
    }
  return edges;
}

std::array<BoxEdge, 4> project_slice(const Camera& camera, const glm::vec3& extents_mm,
                                     SliceAcross across, float share, const Rect& view) {
  const glm::vec3 half = extents_mm / 2.0F;
  const int normal = across == SliceAcross::slow ? 2 : 0;
  std::array<BoxEdge, 4> edges;
  std::size_t next = 0;
  for (const int face : {2 - normal, 1})
    for (const float sign : {-1.0F, 1.0F}) {
      glm::vec3 from = -half;
      glm::vec3 to = half;
      from[normal] = to[normal] = (share - 0.5F) * extents_mm[normal];
      from[face] = to[face] = sign * half[face];
      BoxEdge edge = project_edge(camera, from, to, view);
      edge.in_front = sees_face(camera, half, face, sign);
      edges[next++] = edge;
    }
  return edges;
}

std::array<BoxEdge, 4> project_slow_edges(const Camera& camera, const glm::vec3& extents_mm,
                                          float from, float to, const Rect& view) {
  const glm::vec3 half = extents_mm / 2.0F;
  std::array<BoxEdge, 4> edges;
  std::size_t next = 0;
  for (const float x : {-1.0F, 1.0F})
    for (const float y : {-1.0F, 1.0F}) {
      const glm::vec3 corner{x * half.x, y * half.y, 0};
      const auto at = [&](float share) {
        return corner + glm::vec3{0, 0, (share - 0.5F) * extents_mm.z};
      };
      BoxEdge edge = project_edge(camera, at(from), at(to), view);
      edge.in_front = sees_face(camera, half, 0, x) || sees_face(camera, half, 1, y);
      edges[next++] = edge;
    }
  return edges;
}

} // namespace octascope::ui
