#include "ui/volume/picture_key.h"

#include <algorithm>
#include <cmath>

namespace octascope::ui {

VolumePictureKey volume_picture_key(const VolumeScene& scene, const DrawQuality& quality,
                                    const Rect& rect) {
  const ViewState& view = scene.view;
  return {scene.upload,
          scene.mesh,
          scene.transfer.version(),
          scene.camera.view_projection,
          view.window_offset_db,
          view.window_size_db,
          view.opacity,
          view.technique,
          scene.vessels != nullptr ? scene.vessels->version : 0,
          scene.vessels != nullptr ? scene.vessels->opacity : 1,
          scene.cut_away,
          scene.flow != nullptr,
          scene.step_mm,
          picture_pixels(quality, rect.width),
          picture_pixels(quality, rect.height)};
}

int picture_pixels(const DrawQuality& quality, int display_pixels) {
  const float pixels = static_cast<float>(display_pixels) * quality.resolution;
  return std::max(1, static_cast<int>(std::lround(pixels)));
}

float step_mm(const DrawQuality& quality, const pipeline::VolumeGeometry& geometry) {
  const glm::vec3 extents = box_extents_mm(geometry);
  return std::max({extents.x, extents.y, extents.z}) /
         static_cast<float>(std::max(quality.steps, 1));
}

} // namespace octascope::ui
