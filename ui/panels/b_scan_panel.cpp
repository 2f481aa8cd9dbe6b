#include "ui/panels/b_scan_panel.h"

#include <string>
#include <utility>

#include "embedded_shaders.h"

#include "ui/panels/flow_shader.h"
#include "ui/panels/hatch.h"
#include "ui/view/window.h"

namespace octascope::ui {

namespace {

float middle_of(int index, int count) {
  return (static_cast<float>(index) + 0.5F) / static_cast<float>(count);
}

} // namespace

hal::Result<BScanPanel::Passes> BScanPanel::make(bool flow) {
  const std::string source =
      flow ? flowing(shaders::b_scan_frag) : std::string{shaders::b_scan_frag};
  HAL_TRY(auto marking, gl::PicturePass::create("b_scan", with_hatch(source)));
  HAL_TRY(auto plain, gl::PicturePass::create("b_scan, all good", all_good(source)));
  if (flow)
    for (const gl::PicturePass* pass : {&marking, &plain}) {
      pass->use();
      set_flow_look(pass->program());
    }
  return Passes{Pass{std::move(marking)}, Pass{std::move(plain)}};
}

hal::Result<BScanPanel> BScanPanel::create() {
  HAL_TRY(auto passes, make(false));
  return BScanPanel{std::move(passes)};
}

hal::Result<> BScanPanel::prepare_flow() {
  if (with_flow_)
    return {};
  HAL_TRY(auto passes, make(true));
  with_flow_.emplace(std::move(passes));
  return {};
}

BScanPanel::Pass::Pass(gl::PicturePass made)
    : pass{std::move(made)}, levels{pass.uniform("u_levels")}, window{pass.uniform("u_window")},
      corner{pass.uniform("u_corner")}, across{pass.uniform("u_across")},
      down{pass.uniform("u_down")}, states{pass.uniform("u_states")}, hatch{pass.uniform(
                                                                          "u_hatch")},
      mark_height{pass.uniform("u_mark_height")}, mark{pass.uniform("u_mark")},
      seam{pass.uniform("u_seam")}, flow{pass.uniform("u_flow")}, untold_height{pass.uniform(
                                                                      "u_untold_height")} {}

BScanPanel::BScanPanel(Passes passes) : passes_{std::move(passes)} {}

void BScanPanel::set_marks(const Pass& pass, const StateTexture& states, ScanDirection direction,
                           const Rect& rect, int target_height) {
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, states.name());
  glUniform1i(pass.states, 1);
  set_hatch(pass.hatch, rect, target_height);
  glUniform1f(pass.mark_height, direction == ScanDirection::slow ? mark_share : 0);
  glUniform1f(pass.untold_height, mark_share);
  set_colour(pass.mark, palette::warning);
  set_colour(pass.seam, palette::seam);
}

void BScanPanel::draw(const VolumeTexture& volume, const StateTexture& states,
                      ScanDirection direction, const ViewState& view, const Crop& crop,
                      const Rect& rect, int target_height, const FlowSections* flow) const {
  const WindowRamp window = window_ramp(view);
  const pipeline::VolumeGeometry& geometry = volume.geometry();
  const Passes& passes = flow != nullptr && with_flow_ ? *with_flow_ : passes_;
  const Pass& with = states.all_good() ? passes.plain : passes.marking;
  with.pass.use();
  if (!states.all_good())
    set_marks(with, states, direction, rect, target_height);
  if (with.flow >= 0) {
    glActiveTexture(GL_TEXTURE2);
    glBindTexture(GL_TEXTURE_2D, direction == ScanDirection::fast ? flow->fast() : flow->slow());
    glUniform1i(with.flow, 2);
  }
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
