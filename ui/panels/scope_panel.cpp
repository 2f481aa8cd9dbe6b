#include "ui/panels/scope_panel.h"

#include "embedded_shaders.h"

namespace octascope::ui {

hal::Result<ScopePanel> ScopePanel::create() {
  HAL_TRY(auto pass, gl::PicturePass::create("picture", shaders::picture_frag));
  HAL_TRY(auto picture, ScopeTexture::create());
  return ScopePanel{std::move(pass), std::move(picture)};
}

ScopePanel::ScopePanel(gl::PicturePass pass, ScopeTexture picture)
    : pass_{std::move(pass)}, picture_{std::move(picture)}, uniforms_{
                                                                pass_.uniform("u_picture"),
                                                                pass_.uniform("u_brightness")} {}

hal::Result<> ScopePanel::show(const hal::ScopeFrame& frame,
                               const std::optional<ScanField>& field) {
  HAL_CHECK(picture_.show(frame));
  time_ = frame.time;
  field_ = field;
  return {};
}

void ScopePanel::draw(const Rect& rect, int target_height, bool stale) const {
  pass_.use();
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, picture_.texture().name());
  glUniform1i(uniforms_.picture, 0);
  glUniform1f(uniforms_.brightness, stale ? 0.35F : 1.0F);
  pass_.fill(rect, target_height);
}

} // namespace octascope::ui
