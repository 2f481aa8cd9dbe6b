#include "ui/panels/b_scan_panel.h"

#include "embedded_shaders.h"

#include "ui/panels/hatch.h"
#include "ui/view/window.h"

namespace octascope::ui {

hal::Result<BScanPanel> BScanPanel::create() {
  HAL_TRY(auto pass, gl::PicturePass::create("b_scan", with_hatch(shaders::b_scan_frag)));
  return BScanPanel{std::move(pass)};
}

BScanPanel::BScanPanel(gl::PicturePass pass)
    : pass_{std::move(pass)}, uniforms_{pass_.uniform("u_levels"), pass_.uniform("u_window"),
                                        pass_.uniform("u_slow"), pass_.uniform("u_missing"),
                                        pass_.uniform("u_hatch")} {}

void BScanPanel::draw(const VolumeTexture& volume, pipeline::BScanState state,
                      const ViewState& view, const Rect& rect, int target_height) const {
  const WindowRamp window = window_ramp(view);
  const auto count = static_cast<float>(volume.geometry().b_scans);
  pass_.use();
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_3D, volume.name());
  glUniform1i(uniforms_.levels, 0);
  glUniform2f(uniforms_.window, window.scale, window.offset);
  glUniform1f(uniforms_.slow, (static_cast<float>(view.b_scan) + 0.5F) / count);
  glUniform1i(uniforms_.missing, state == pipeline::BScanState::missing ? 1 : 0);
  set_hatch(uniforms_.hatch, rect, target_height);
  pass_.fill(rect, target_height);
}

} // namespace octascope::ui
