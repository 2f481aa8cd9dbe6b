#include "ui/splash.h"

#include <string>

#include "ui/canvas/canvas.h"
#include "ui/canvas/canvas_renderer.h"
#include "ui/layout/layout.h"
#include "ui/layout/stereo.h"

namespace octascope::ui {

namespace {

void clear(int width, int height) {
  constexpr Colour ground = palette::background;
  glViewport(0, 0, width, height);
  glDisable(GL_SCISSOR_TEST);
  glClearColor(ground.r / 255.0F, ground.g / 255.0F, ground.b / 255.0F, 1);
  glClear(GL_COLOR_BUFFER_BIT);
}

void lay_out_words(Canvas& canvas, glm::vec2 size, float unit, std::string_view version,
                   std::string_view doing) {
  const auto centred = [&](float y, TextStyle style, Colour colour, std::string_view words) {
    canvas.text({(size.x - canvas.text_width(style, words)) / 2, y}, style, colour, words);
    return y + canvas.text_height(style) + 8 * unit;
  };
  const float line = 2 * canvas.text_height(TextStyle::badge);
  float y = size.y / 2 - line;
  y = centred(y, TextStyle::badge, palette::text, "octascope");
  y = centred(y, TextStyle::value, palette::accent, doing);
  centred(size.y - line, TextStyle::label, palette::quiet_text,
          std::string{"version "}.append(version).append(" · not a medical device"));
}

} // namespace

hal::Result<> draw_splash(int width, int height, std::string_view version, std::string_view doing) {
  const float unit = lay_out(width, height, {}).unit;
  HAL_TRY(auto fonts, Fonts::create(unit));
  HAL_TRY(auto renderer, CanvasRenderer::create());
  Canvas canvas;
  canvas.begin(fonts, width, height);
  lay_out_words(canvas, {width, height}, unit, version, doing);
  clear(width, height);
  renderer.draw(canvas, eye_frame(StereoMode::off, StereoEye::centre, width, height), height);
  return {};
}

} // namespace octascope::ui
