#include "ui/panels/en_face_panel.h"

#include "embedded_shaders.h"

#include "ui/gl/picture_texture.h"
#include "ui/hud/palette.h"
#include "ui/panels/hatch.h"
#include "ui/panels/projection.h"

namespace octascope::ui {

hal::Result<EnFacePanel> EnFacePanel::create() {
  HAL_TRY(auto pass, gl::PicturePass::create("en_face", with_hatch(shaders::en_face_frag)));
  return EnFacePanel{std::move(pass)};
}

EnFacePanel::EnFacePanel(gl::PicturePass pass)
    : pass_{std::move(pass)}, uniforms_{pass_.uniform("u_projection"), pass_.uniform("u_states"),
                                        pass_.uniform("u_hatch"), pass_.uniform("u_mark_width"),
                                        pass_.uniform("u_mark")} {}

void EnFacePanel::allocate(int a_scans, int b_scans) {
  a_scans_ = a_scans;
  b_scans_ = b_scans;
  sums_.resize(static_cast<std::size_t>(a_scans) * static_cast<std::size_t>(b_scans));
  grey_.resize(sums_.size());
  projection_ = gl::make_picture_texture(GL_R8, a_scans, b_scans);
  states_ = gl::Texture::make();
  glBindTexture(GL_TEXTURE_2D, states_.name());
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_R8UI, b_scans, 1);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

void EnFacePanel::show(const pipeline::Volume& volume) {
  static_assert(sizeof(pipeline::BScanState) == 1, "uploaded as one byte a B-scan");
  if (volume.geometry.a_scans != a_scans_ || volume.geometry.b_scans != b_scans_)
    allocate(volume.geometry.a_scans, volume.geometry.b_scans);
  project_sum(volume, sums_);
  stretch_contrast(volume, sums_, grey_);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glBindTexture(GL_TEXTURE_2D, projection_.name());
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, a_scans_, b_scans_, GL_RED, GL_UNSIGNED_BYTE,
                  grey_.data());
  glBindTexture(GL_TEXTURE_2D, states_.name());
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, b_scans_, 1, GL_RED_INTEGER, GL_UNSIGNED_BYTE,
                  volume.b_scan_states.data());
}

void EnFacePanel::draw(const Rect& rect, int target_height) const {
  pass_.use();
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, states_.name());
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, projection_.name());
  glUniform1i(uniforms_.projection, 0);
  glUniform1i(uniforms_.states, 1);
  set_hatch(uniforms_.hatch, rect, target_height);
  glUniform1f(uniforms_.mark_width, 0.04F);
  constexpr Colour mark = palette::warning;
  glUniform3f(uniforms_.mark, static_cast<float>(mark.r) / 255, static_cast<float>(mark.g) / 255,
              static_cast<float>(mark.b) / 255);
  pass_.fill(rect, target_height);
}

} // namespace octascope::ui
