#include "ui/volume/slice_stack.h"

#include "ui/volume/slice_spacing.h"

namespace octascope::ui {

hal::Result<SliceStack> SliceStack::create(WithFlow flow) {
  HAL_TRY(auto stack, PolygonStack::create(flow));
  return SliceStack{std::move(stack)};
}

void SliceStack::do_draw(const VolumeScene& scene) {
  const Camera& camera = scene.camera;
  const glm::vec3 half = box_extents_mm(scene.volume.geometry()) / 2.0F;
  const SliceSpacing spacing =
      space_slices(camera, scene.volume.geometry(), scene.step_mm, PolygonStack::most_polygons);
  glm::vec3 normal{0};
  normal[spacing.axis] = spacing.direction;
  stack_.clear();
  for (int i = 0; i < spacing.drawn; ++i) {
    const float offset = spacing.offset_mm(i);
    if ((offset - camera.eye[spacing.axis]) * spacing.direction > 0) // else behind the eye
      stack_.add(intersect_plane_box(half, normal, offset * spacing.direction));
  }
  stack_.draw(scene, {normal, spacing.spacing_mm, false});
}

} // namespace octascope::ui
