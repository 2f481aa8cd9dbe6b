#include <algorithm>
#include <cmath>

#include "ui/hud/hud.h"

namespace octascope::ui {

Colour depth_hue(float place) {
  const std::array<float, 3> tint = depth_tint(place);
  const auto bits = [](float v) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(v, 0.0F, 1.0F)));
  };
  return {bits(tint[0]), bits(tint[1]), bits(tint[2])};
}

bool has_room_for_depth_scale(const Layout& layout) {
  const float u = layout.unit;
  return static_cast<float>(layout.view.width) >= 370 * u &&
         static_cast<float>(layout.view.height) >= 160 * u;
}

void draw_depth_scale(Canvas& canvas, const Layout& layout, const HudScene& scene) {
  if (!scene.depth_colours || !has_room_for_depth_scale(layout))
    return;
  const float u = layout.unit;
  const float letters = canvas.text_height(TextStyle::label);
  const Rect& view = layout.view;
  const float quarter = static_cast<float>(view.height) / 4;
  const float left = static_cast<float>(view.x) + (layout.view_frame.empty() ? 16 : 8) * u;
  const float top = static_cast<float>(view.y) + quarter + letters / 2;
  const float height = static_cast<float>(view.height) - 2 * quarter - 2 * letters - 8 * u;
  const float width = 12 * u;
  canvas.bar({left - u, top - u}, {left + width + u, top + height + u}, palette::ink.faded(160));
  constexpr int pieces = 48;
  const auto y_of = [&](float place) { return top + place * height; };
  for (int i = 0; i < pieces; ++i) {
    const float from = static_cast<float>(i) / pieces;
    const float to = static_cast<float>(i + 1) / pieces;
    canvas.bar({left, y_of(from)}, {left + width, y_of(to)}, depth_hue((from + to) / 2));
  }
  const double depth_mm = scene.shown.geometry.depth_mm();
  const double first_mm = depth_mm * static_cast<double>(scene.depth_colours->from);
  const double last_mm = depth_mm * static_cast<double>(scene.depth_colours->to);
  const double step_mm = round_ruler_step_mm((last_mm - first_mm) / static_cast<double>(height) *
                                             1.6 * static_cast<double>(letters));
  const bool in_mm = step_mm >= 0.1;
  bool said = false; // the unit: once, at the first
  for (auto i = static_cast<int>(std::ceil(first_mm / step_mm)); i * step_mm <= last_mm; ++i) {
    const float y = y_of(static_cast<float>((i * step_mm - first_mm) / (last_mm - first_mm)));
    canvas.line({left + width, y}, {left + width + 5 * u, y}, palette::text, std::max(1.0F, 2 * u));
    FixedText<16> words;
    words.format("{:g}{}", i * step_mm * (in_mm ? 1 : 1e3), said ? "" : in_mm ? " mm" : " µm");
    said = true;
    canvas.shadowed_text({left + width + 8 * u, y - letters / 2}, TextStyle::label, palette::text,
                         words.view());
  }
  canvas.shadowed_text({left, top + height + 8 * u}, TextStyle::label, palette::text,
                       medium_words(scene.shown.geometry.refractive_index).view());
}

} // namespace octascope::ui
