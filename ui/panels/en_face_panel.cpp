#include "ui/panels/en_face_panel.h"

#include <algorithm>
#include <utility>

#include "embedded_shaders.h"

#include "ui/gl/picture_texture.h"
#include "ui/panels/hatch.h"
#include "ui/panels/projection.h"

namespace octascope::ui {

hal::Result<EnFacePanel> EnFacePanel::create() {
  HAL_TRY(auto pass, gl::PicturePass::create("en_face", with_hatch(shaders::en_face_frag)));
  HAL_TRY(auto plain,
          gl::PicturePass::create("en_face, all good", all_good(shaders::en_face_frag)));
  return EnFacePanel{std::move(pass), std::move(plain)};
}

EnFacePanel::EnFacePanel(gl::PicturePass pass, gl::PicturePass plain)
    : pass_{std::move(pass)}, plain_{std::move(plain)}, uniforms_{pass_.uniform("u_projection"),
                                                                  pass_.uniform("u_states"),
                                                                  pass_.uniform("u_corner"),
                                                                  pass_.uniform("u_extent"),
                                                                  pass_.uniform("u_hatch"),
                                                                  pass_.uniform("u_mark_width"),
                                                                  pass_.uniform("u_mark"),
                                                                  pass_.uniform("u_seam")},
      plain_uniforms_{plain_.uniform("u_projection"), plain_.uniform("u_corner"),
                      plain_.uniform("u_extent")} {}

void EnFacePanel::allocate(int a_scans, int b_scans) {
  a_scans_ = a_scans;
  b_scans_ = b_scans;
  levels_.resize(static_cast<std::size_t>(a_scans) * static_cast<std::size_t>(b_scans));
  wanted_.resize(static_cast<std::size_t>(b_scans));
  grey_ = levels_;
  before_.clear();
  projection_ = gl::make_picture_texture(GL_R8, a_scans, b_scans);
}

void EnFacePanel::show(const pipeline::Volume& volume, const TissueMap& tissue,
                       std::span<const pipeline::BScanRange> changed, WorkTeam* team) {
  const bool other = volume.geometry.a_scans != a_scans_ || volume.geometry.b_scans != b_scans_;
  if (other)
    allocate(volume.geometry.a_scans, volume.geometry.b_scans);
  for (int b = 0; b < b_scans_; ++b)
    wanted_[static_cast<std::size_t>(b)] =
        other || changed.empty() || tissue.changed_at(b) ? std::uint8_t{1} : std::uint8_t{0};
  for (const pipeline::BScanRange& range : changed)
    std::fill(wanted_.begin() + range.from, wanted_.begin() + range.to, std::uint8_t{1});
  project_slab(volume, tissue, levels_, wanted_, team);
  std::swap(grey_, before_);
  grey_.assign(levels_.begin(), levels_.end());
  stretch_contrast(volume, grey_);
  compare_rows();
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glBindTexture(GL_TEXTURE_2D, projection_.name());
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, a_scans_, b_scans_, GL_RED, GL_UNSIGNED_BYTE,
                  grey_.data());
}

void EnFacePanel::compare_rows() {
  changed_.assign(static_cast<std::size_t>(b_scans_), 1);
  if (before_.size() != grey_.size())
    return;
  const auto length = static_cast<std::size_t>(a_scans_);
  for (std::size_t b = 0; b < changed_.size(); ++b) {
    const auto row = std::span{grey_}.subspan(b * length, length);
    changed_[b] = std::ranges::equal(row, std::span{before_}.subspan(b * length, length)) ? 0 : 1;
  }
}

void EnFacePanel::draw(const StateTexture& states, const Crop& crop, const Rect& rect,
                       int target_height) const {
  if (states.all_good())
    return draw_plain(crop, rect, target_height);
  pass_.use();
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, states.name());
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, projection_.name());
  glUniform1i(uniforms_.projection, 0);
  glUniform1i(uniforms_.states, 1);
  glUniform2f(uniforms_.corner, crop.a.from, crop.b.from);
  glUniform2f(uniforms_.extent, crop.a.length(), crop.b.length());
  set_hatch(uniforms_.hatch, rect, target_height);
  glUniform1f(uniforms_.mark_width, mark_share);
  set_colour(uniforms_.mark, palette::warning);
  set_colour(uniforms_.seam, palette::seam);
  pass_.fill(rect, target_height);
}

void EnFacePanel::draw_plain(const Crop& crop, const Rect& rect, int target_height) const {
  plain_.use();
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, projection_.name());
  glUniform1i(plain_uniforms_.projection, 0);
  glUniform2f(plain_uniforms_.corner, crop.a.from, crop.b.from);
  glUniform2f(plain_uniforms_.extent, crop.a.length(), crop.b.length());
  plain_.fill(rect, target_height);
}

} // namespace octascope::ui
