#include "ui/camera.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

namespace octascope::ui {

float Camera::depth_of(const glm::vec3& point) const {
  return glm::dot(point - eye, forward);
}

glm::vec2 Camera::project(const glm::vec3& point) const {
  const glm::vec3 ray = point - eye;
  const float height = 2 * tan_half_height * glm::dot(ray, forward);
  return {glm::dot(ray, right) / height, -glm::dot(ray, up) / height};
}

glm::vec3 box_extents_mm(const pipeline::VolumeGeometry& geometry) {
  return {static_cast<float>(geometry.a_mm()), static_cast<float>(geometry.depth_mm()),
          static_cast<float>(geometry.b_mm())};
}

Camera make_camera(const ViewState& view, const glm::vec3& extents_mm, float aspect) {
  const float yaw = glm::radians(view.yaw_deg);
  const float tilt = glm::radians(view.tilt_deg);
  const float radius = glm::length(extents_mm) / 2;
  const glm::vec3 outwards{std::sin(yaw) * std::cos(tilt), std::sin(tilt),
                           std::cos(yaw) * std::cos(tilt)};
  Camera camera;
  camera.eye = outwards * (view.distance * radius);
  camera.forward = -outwards;
  camera.right = glm::vec3{std::cos(yaw), 0, -std::sin(yaw)};
  camera.up = glm::cross(camera.right, camera.forward);
  camera.near_mm = std::max(view.distance - 1.001F, 0.02F) * radius;
  camera.far_mm = (view.distance + 1.001F) * radius;
  camera.tan_half_height = std::tan(glm::radians(field_of_view_deg) / 2) / std::min(aspect, 1.0F);
  const glm::mat4 projection = glm::perspective(2 * std::atan(camera.tan_half_height), aspect,
                                                camera.near_mm, camera.far_mm);
  camera.view_projection = projection * glm::lookAt(camera.eye, glm::vec3{0}, camera.up);
  return camera;
}

} // namespace octascope::ui
