#include "ui/depth_mask/depth_mask.h"

namespace octascope::ui {

void set_depth_mask(const gl::Program& program, const DepthMask* stops, const Camera& camera) {
  constexpr GLint unit = 3;
  glUniform1i(program.uniform("u_stops"), unit);
  glUniform1i(program.uniform("u_stopped"), stops != nullptr ? 1 : 0);
  if (stops == nullptr)
    return;
  const float range = camera.far_mm - camera.near_mm;
  glUniform2f(program.uniform("u_stop_depth"), camera.near_mm * camera.far_mm / range,
              camera.far_mm / range);
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(GL_TEXTURE_2D, stops->depth);
  glActiveTexture(GL_TEXTURE0);
}

} // namespace octascope::ui
