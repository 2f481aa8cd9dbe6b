#include "ui/scene/vessel_still.h"

#include <algorithm>

#include "embedded_shaders.h"

#include "ui/canvas/palette.h"
#include "ui/hud/hud.h"

namespace octascope::ui {

namespace {

constexpr float least_unit = 0.5F;    // words stay legible in the smallest picture
constexpr float margin = 16;          // at unit 1
constexpr float longest_share = 0.2F; // of the picture's width

void clear(const Rect& rect) {
  constexpr Colour back = palette::background;
  glViewport(rect.x, rect.y, rect.width, rect.height);
  glClearColor(static_cast<float>(back.r) / 255, static_cast<float>(back.g) / 255,
               static_cast<float>(back.b) / 255, 1);
  glClear(GL_COLOR_BUFFER_BIT);
}

} // namespace

hal::Result<VesselStill> VesselStill::create() {
  HAL_TRY(auto picture, VesselPicture::create());
  HAL_TRY(auto pass, gl::PicturePass::create("composite", shaders::composite_frag));
  HAL_TRY(auto canvas_renderer, CanvasRenderer::create());
  return VesselStill{std::move(picture), std::move(pass), std::move(canvas_renderer)};
}

void VesselStill::lay_over_background(const Rect& rect) const {
  clear(rect);
  pass_.use();
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, picture_.colour_texture());
  glUniform1i(pass_.uniform("u_picture"), 0);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  pass_.fill(rect, rect.height);
  glDisable(GL_BLEND);
}

hal::Result<SegmentCounts> VesselStill::draw(VesselMethod& method, const VesselScene& scene,
                                             float mm_per_pixel) {
  const Rect rect{0, 0, scene.width, scene.height};
  const float unit = std::max(least_unit, lay_out(rect.width, rect.height, {}).unit);
  HAL_TRY(const auto fonts, Fonts::create(unit));
  const auto account = picture_.draw(method, scene);
  if (!account)
    return account;
  lay_over_background(rect);
  Canvas canvas;
  canvas.begin(fonts, rect.width, rect.height);
  draw_scale_bar(canvas, {margin * unit, static_cast<float>(rect.height) - margin * unit},
                 static_cast<double>(mm_per_pixel), longest_share * static_cast<float>(rect.width),
                 unit);
  canvas_renderer_.draw(canvas, {rect, rect.width, rect.height}, rect.height);
  return account;
}

} // namespace octascope::ui
