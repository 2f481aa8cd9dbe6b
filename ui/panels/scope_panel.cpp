#include "ui/panels/scope_panel.h"

#include "embedded_shaders.h"

#include "ui/gl/picture_texture.h"
#include "ui/panels/scope_pixels.h"

namespace octascope::ui {

hal::Result<ScopePanel> ScopePanel::create() {
  auto pass = gl::PicturePass::create("picture", shaders::picture_frag);
  if (!pass)
    return tl::make_unexpected(pass.error());
  return ScopePanel{std::move(*pass)};
}

ScopePanel::ScopePanel(gl::PicturePass pass)
    : pass_{std::move(pass)}, uniforms_{pass_.uniform("u_picture"), pass_.uniform("u_brightness")} {
}

hal::Result<> ScopePanel::show(const hal::ScopeFrame& frame,
                               const std::optional<ScanField>& field) {
  const bool resized = !texture_ || frame.width != width_ || frame.height != height_;
  if (resized && frame.width > 0 && frame.height > 0)
    rgba_.resize(4 * static_cast<std::size_t>(frame.width) *
                 static_cast<std::size_t>(frame.height));
  if (auto ok = convert_to_rgba(frame, rgba_); !ok)
    return ok;
  if (resized) {
    texture_ = gl::make_picture_texture(GL_RGBA8, frame.width, frame.height);
    width_ = frame.width;
    height_ = frame.height;
  }
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, height_, GL_RGBA, GL_UNSIGNED_BYTE, rgba_.data());
  time_ = frame.time;
  field_ = field;
  return {};
}

void ScopePanel::draw(const Rect& rect, int target_height, bool stale) const {
  pass_.use();
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, texture_.name());
  glUniform1i(uniforms_.picture, 0);
  glUniform1f(uniforms_.brightness, stale ? 0.35F : 1.0F);
  pass_.fill(rect, target_height);
}

} // namespace octascope::ui
