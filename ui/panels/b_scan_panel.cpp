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
  HAL_TRY(auto plain, gl::PicturePass::create("b_scan, all good", all_good(shaders::b_scan_frag)));
  return BScanPanel{std::move(pass), std::move(plain)};
}

BScanPanel::Pass::Pass(gl::PicturePass made)
    : pass{std::move(made)}, levels{pass.uniform("u_levels")}, window{pass.uniform("u_window")},
      corner{pass.uniform("u_corner")}, across{pass.uniform("u_across")}, down{pass.uniform(
                                                                              "u_down")} {}

BScanPanel::BScanPanel(gl::PicturePass pass, gl::PicturePass plain)
    : marking_{std::move(pass)}, plain_{std::move(plain)},
      marks_{marking_.pass.uniform("u_states"), marking_.pass.uniform("u_hatch"),
             marking_.pass.uniform("u_mark_height"), marking_.pass.uniform("u_mark"),
             marking_.pass.uniform("u_seam")} {}

void BScanPanel::set_marks(const StateTexture& states, ScanDirection direction, const Rect& rect,
                           int target_height) const {
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, states.name());
  glUniform1i(marks_.states, 1);
  set_hatch(marks_.hatch, rect, target_height);
  glUniform1f(marks_.mark_height, direction == ScanDirection::slow ? mark_share : 0);
  set_colour(marks_.mark, palette::warning);
  set_colour(marks_.seam, palette::seam);
}

void BScanPanel::draw(const VolumeTexture& volume, const StateTexture& states,
                      ScanDirection direction, const ViewState& view, const Crop& crop,
                      const Rect& rect, int target_height) const {
  const WindowRamp window = window_ramp(view);
  const pipeline::VolumeGeometry& geometry = volume.geometry();
  const Pass& with = states.all_good() ? plain_ : marking_;
  with.pass.use();
  if (!states.all_good())
    set_marks(states, direction, rect, target_height);
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_3D, volume.name());
  glUniform1i(with.levels, 0);
  glUniform2f(with.window, window.scale, window.offset);
  if (direction == ScanDirection::fast) {
    glUniform3f(with.corner, crop.depth.from, crop.a.from,
                middle_of(view.b_scan, geometry.b_scans));
    glUniform3f(with.across, 0, crop.a.length(), 0);
  } else {
    glUniform3f(with.corner, crop.depth.from, middle_of(view.a_scan, geometry.a_scans),
                crop.b.from);
    glUniform3f(with.across, 0, 0, crop.b.length());
  }
  glUniform3f(with.down, crop.depth.length(), 0, 0);
  with.pass.fill(rect, target_height);
}

} // namespace octascope::ui
