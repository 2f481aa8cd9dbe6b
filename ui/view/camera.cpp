#include "ui/view/camera.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

namespace octascope::ui {

namespace {

// What the box's corners need across at the first distance, from any side: 1 / √(3.1² - 1), and a
// little. Upright its diagonal is never seen.
constexpr float least_tan_half_width = 0.345F;

// Of the eye to the right of the line from between the eyes to the volume's centre.
float tangent_of(StereoEye eye, float parallax_deg) {
  const float half = std::tan(glm::radians(parallax_deg) / 2);
  return eye == StereoEye::centre ? 0 : eye == StereoEye::left ? -half : half;
}

} // namespace

float Camera::depth_of(const glm::vec3& point) const {
  return glm::dot(point - eye, forward);
}

glm::vec2 Camera::project(const glm::vec3& point) const {
  const glm::vec3 ray = point - eye;
  const float height = 2 * tan_half_height * glm::dot(ray, forward);
  const float across = glm::dot(ray, right) - centre_shift * glm::dot(ray, forward);
  return {across / height, -glm::dot(ray, up) / height};
}

glm::vec3 box_extents_mm(const pipeline::VolumeGeometry& geometry) {
  return {static_cast<float>(geometry.a_mm()), static_cast<float>(geometry.depth_mm()),
          static_cast<float>(geometry.b_mm())};
}

Camera make_camera(const ViewState& view, const glm::vec3& extents_mm, float aspect,
                   StereoEye eye) {
  const float yaw = glm::radians(view.yaw_deg);
  const float tilt = glm::radians(view.tilt_deg);
  const float radius = glm::length(extents_mm) / 2;
  const glm::vec3 outwards{std::sin(yaw) * std::cos(tilt), std::sin(tilt),
                           std::cos(yaw) * std::cos(tilt)};
  Camera camera;
  const float tangent = tangent_of(eye, view.parallax_deg);
  camera.forward = -outwards;
  camera.right = glm::vec3{std::cos(yaw), 0, -std::sin(yaw)};
  camera.eye = (outwards + tangent * camera.right) * (view.distance * radius);
  camera.centre_shift = -tangent;
  camera.up = glm::cross(camera.right, camera.forward);
  camera.near_mm = std::max(view.distance - 1.001F, 0.02F) * radius;
  camera.far_mm = (view.distance + 1.001F) * radius;
  camera.aspect = aspect;
  camera.tan_half_height =
      std::max(std::tan(glm::radians(field_of_view_deg) / 2), least_tan_half_width / aspect);
  const float top = camera.near_mm * camera.tan_half_height;
  const float middle = camera.near_mm * camera.centre_shift;
  const glm::mat4 projection = glm::frustum(middle - top * aspect, middle + top * aspect, -top, top,
                                            camera.near_mm, camera.far_mm);
  camera.view_projection =
      projection * glm::lookAt(camera.eye, camera.eye + camera.forward, camera.up);
  return camera;
}

} // namespace octascope::ui
