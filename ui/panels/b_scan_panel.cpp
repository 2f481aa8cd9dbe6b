#include "ui/panels/b_scan_panel.h"

#include "embedded_shaders.h"

#include "ui/panels/hatch.h"
#include "ui/view/window.h"

namespace octascope::ui {

namespace {

float middle_of(int index, int count) {
  return (static_cast<float>(index) + 0.5F) / static_cast<float>(count);
}

} // namespace

hal::Result<BScanPanel> BScanPanel::create() {
  HAL_TRY(auto pass, gl::PicturePass::create("b_scan", with_hatch(shaders::b_scan_frag)));
  return BScanPanel{std::move(pass)};
}

BScanPanel::BScanPanel(gl::PicturePass pass)
    : pass_{std::move(pass)}, uniforms_{pass_.uniform("u_levels"), pass_.uniform("u_states"),
                                        pass_.uniform("u_window"), pass_.uniform("u_corner"),
                                        pass_.uniform("u_across"), pass_.uniform("u_down"),
                                        pass_.uniform("u_hatch"),  pass_.uniform("u_mark_height"),
                                        pass_.uniform("u_mark"),   pass_.uniform("u_seam")} {}

void BScanPanel::draw(const VolumeTexture& volume, const StateTexture& states,
                      ScanDirection direction, const ViewState& view, const Crop& crop,
                      const Rect& rect, int target_height) const {
  const WindowRamp window = window_ramp(view);
  const pipeline::VolumeGeometry& geometry = volume.geometry();
  pass_.use();
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, states.name());
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_3D, volume.name());
  glUniform1i(uniforms_.levels, 0);
  glUniform1i(uniforms_.states, 1);
  glUniform2f(uniforms_.window, window.scale, window.offset);
  if (direction == ScanDirection::fast) {
    glUniform3f(uniforms_.corner, crop.depth.from, crop.a.from,
                middle_of(view.b_scan, geometry.b_scans));
    glUniform3f(uniforms_.across, 0, crop.a.length(), 0);
  } else {
    glUniform3f(uniforms_.corner, crop.depth.from, middle_of(view.a_scan, geometry.a_scans),
                crop.b.from);
    glUniform3f(uniforms_.across, 0, 0, crop.b.length());
  }
  glUniform3f(uniforms_.down, crop.depth.length(), 0, 0);
  set_hatch(uniforms_.hatch, rect, target_height);
  glUniform1f(uniforms_.mark_height, direction == ScanDirection::slow ? mark_share : 0);
  set_colour(uniforms_.mark, palette::warning);
  set_colour(uniforms_.seam, palette::seam);
  pass_.fill(rect, target_height);
}

} // namespace octascope::ui
