#include "ui/volume/picture_key.h"

#include <algorithm>
#include <cmath>

namespace octascope::ui {

VolumePictureKey volume_picture_key(const VolumeScene& scene, const DrawQuality& quality,
                                    const Rect& rect) {
  const auto pixels = [&](int length) {
    return std::max(1,
                    static_cast<int>(std::lround(static_cast<float>(length) * quality.resolution)));
  };
  const ViewState& view = scene.view;
  return {scene.upload,
          scene.mesh,
          scene.transfer.version(),
          scene.camera.view_projection,
          view.window_offset_db,
          view.window_size_db,
          view.opacity,
          view.technique,
          scene.step_mm,
          pixels(rect.width),
          pixels(rect.height)};
}

float step_mm(const DrawQuality& quality, const pipeline::VolumeGeometry& geometry) {
  const glm::vec3 extents = box_extents_mm(geometry);
  return std::max({extents.x, extents.y, extents.z}) /
         static_cast<float>(std::max(quality.steps, 1));
}

} // namespace octascope::ui
