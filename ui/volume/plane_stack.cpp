#include "ui/volume/plane_stack.h"

#include <glm/geometric.hpp>

namespace octascope::ui {

hal::Result<PlaneStack> PlaneStack::create(WithFlow flow) {
  HAL_TRY(auto stack, PolygonStack::create(flow));
  return PlaneStack{std::move(stack)};
}

void PlaneStack::do_draw(const VolumeScene& scene) {
  const Camera& camera = scene.camera;
  const glm::vec3 half = box_extents_mm(scene.volume.geometry()) / 2.0F;
  const int planes = count_planes(camera, half, scene.step_mm, PolygonStack::most_polygons);
  const StackSpacing spacing = space_planes(camera, half, planes);
  const float eye_offset = glm::dot(camera.eye, camera.forward);
  stack_.clear();
  for (int i = 0; i < planes; ++i) {
    const float distance = spacing.first_mm + static_cast<float>(i) * spacing.spacing_mm;
    stack_.add(intersect_plane_box(half, camera.forward, eye_offset + distance));
  }
  stack_.draw(scene, {camera.forward, spacing.spacing_mm, true});
}

} // namespace octascope::ui
