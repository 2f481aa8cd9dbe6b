#include "ui/panels/field_flow.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "embedded_shaders.h"

#include "ui/panels/flow_shader.h"

namespace octascope::ui {

hal::Result<FieldFlow> FieldFlow::create() {
  HAL_TRY(auto pass,
          gl::PicturePass::create("field_flow", seen_from_above(shaders::field_flow_frag)));
  return FieldFlow{std::move(pass)};
}

FieldFlow::FieldFlow(gl::PicturePass pass)
    : pass_{std::move(pass)}, corners_{pass_.uniform("u_corners")}, tint_place_{pass_.uniform(
                                                                        "u_tint_place")} {
  set_flow_from_above(pass_.program());
  glUniform1i(pass_.uniform("u_flow"), 0);
}

void FieldFlow::draw(const gl::Texture& flow, float deepest, const ScanField& field,
                     const Rect& rect, int target_height) const {
  pass_.use();
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, flow.name());
  glUniform2fv(corners_, 4, &field.corners[0].x);
  glUniform2f(tint_place_, 1 / std::max(deepest, 1e-3F), 0);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  pass_.fill(rect, target_height);
  glDisable(GL_BLEND);
}

Rect around(const ScanField& field, const Rect& rect) {
  float left = 1, top = 1, right = 0, bottom = 0;
  for (const ScanField::Corner& corner : field.corners) {
    left = std::min(left, corner.x);
    top = std::min(top, corner.y);
    right = std::max(right, corner.x);
    bottom = std::max(bottom, corner.y);
  }
  const auto place = [](float share, int length) {
    return static_cast<int>(
        std::lround(std::clamp(share, 0.0F, 1.0F) * static_cast<float>(length)));
  };
  const int x = place(left, rect.width);
  const int y = place(top, rect.height);
  return {rect.x + x, rect.y + y, std::max(place(right, rect.width) - x, 0),
          std::max(place(bottom, rect.height) - y, 0)};
}

} // namespace octascope::ui
