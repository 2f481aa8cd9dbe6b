#include <algorithm>
#include <cmath>

#include "ui/hud/hud.h"

namespace octascope::ui {

namespace {

Colour colour_of(Tone tone) {
  return tone == Tone::warning ? palette::warning : palette::quiet_text;
}

void draw_caption(Canvas& canvas, const Panel& panel, const Caption& caption, float unit) {
  const float height = canvas.text_height(TextStyle::body);
  const float y =
      static_cast<float>(panel.title.y) + (static_cast<float>(panel.title.height) - height) / 2;
  canvas.text({static_cast<float>(panel.title.x) + 2 * unit, y}, TextStyle::body, palette::text,
              caption.title.view());
  const float width = canvas.text_width(TextStyle::body, caption.note.view());
  canvas.text({static_cast<float>(panel.title.right()) - 2 * unit - width, y}, TextStyle::body,
              colour_of(caption.note_tone), caption.note.view());
}

void draw_words_within(Canvas& canvas, const Rect& rect, Colour colour, std::string_view words,
                       float unit) {
  const float width = canvas.text_width(TextStyle::badge, words);
  const float height = canvas.text_height(TextStyle::badge);
  const float x = static_cast<float>(rect.x) + (static_cast<float>(rect.width) - width) / 2;
  const float y = static_cast<float>(rect.y) + (static_cast<float>(rect.height) - height) / 2;
  canvas.plate({static_cast<int>(x - 12 * unit), static_cast<int>(y - 6 * unit),
                static_cast<int>(width + 24 * unit), static_cast<int>(height + 12 * unit)},
               palette::panel, 4 * unit);
  canvas.text({x, y}, TextStyle::badge, colour, words);
}

void draw_position_line(Canvas& canvas, const Rect& rect, const ViewState& view, int b_scans,
                        float unit) {
  const float y = static_cast<float>(rect.y) + static_cast<float>(rect.height) *
                                                   (static_cast<float>(view.b_scan) + 0.5F) /
                                                   static_cast<float>(b_scans);
  const auto left = static_cast<float>(rect.x);
  const auto right = static_cast<float>(rect.right());
  canvas.line({left, y}, {right, y}, palette::accent.faded(150), std::max(1.0F, 1.2F * unit));
  // Short and bright at both ends, where they hide nothing.
  canvas.line({left - 6 * unit, y}, {left + 6 * unit, y}, palette::accent, 3 * unit);
  canvas.line({right - 6 * unit, y}, {right + 6 * unit, y}, palette::accent, 3 * unit);
}

void draw_scan_field(Canvas& canvas, const Rect& rect, const ScanField& field, float unit) {
  const auto pixel = [&](const ScanField::Corner& corner) {
    return glm::vec2{static_cast<float>(rect.x) + corner.x * static_cast<float>(rect.width),
                     static_cast<float>(rect.y) + corner.y * static_cast<float>(rect.height)};
  };
  for (std::size_t i = 0; i < field.corners.size(); ++i)
    canvas.line(pixel(field.corners[i]), pixel(field.corners[(i + 1) % field.corners.size()]),
                palette::accent, 2 * unit);
  canvas.dot(pixel(field.corners[0]), 4 * unit, palette::accent);
}

void draw_panel_scale(Canvas& canvas, const Rect& rect, double width_mm, float unit) {
  draw_scale_bar(
      canvas, {static_cast<float>(rect.x) + 8 * unit, static_cast<float>(rect.bottom()) - 8 * unit},
      width_mm / rect.width, static_cast<float>(rect.width) * 0.4F, unit);
}

} // namespace

double round_scale_length_mm(double longest_mm) {
  const double power = std::pow(10.0, std::floor(std::log10(longest_mm)));
  for (const double digit : {5.0, 2.0})
    if (digit * power <= longest_mm)
      return digit * power;
  return power;
}

void draw_scale_bar(Canvas& canvas, glm::vec2 left_bottom, double mm_per_pixel, float most_pixels,
                    float unit) {
  const double length_mm = round_scale_length_mm(mm_per_pixel * static_cast<double>(most_pixels));
  const auto pixels = static_cast<float>(length_mm / mm_per_pixel);
  const glm::vec2 from{left_bottom.x, left_bottom.y - 2 * unit};
  const glm::vec2 to{from.x + pixels, from.y};
  const auto bar = [&](Colour colour, float grow) {
    canvas.line({from.x - grow, from.y}, {to.x + grow, to.y}, colour, 3 * unit + 2 * grow);
  };
  bar(palette::ink.faded(160), unit);
  bar(palette::text, 0);
  FixedText<16> words;
  if (length_mm < 0.1)
    words.format("{:.0f} µm", length_mm * 1000);
  else
    words.format("{:g} mm", length_mm);
  const float y = from.y - 5 * unit - canvas.text_height(TextStyle::body);
  // A shadow keeps it legible on bright tissue.
  for (const glm::vec2 shift :
       {glm::vec2{1, 1}, glm::vec2{-1, 1}, glm::vec2{1, -1}, glm::vec2{-1, -1}})
    canvas.text({from.x + shift.x * unit, y + shift.y * unit}, TextStyle::body,
                palette::ink.faded(200), words.view());
  canvas.text({from.x, y}, TextStyle::body, palette::text, words.view());
}

void draw_panel_marks(Canvas& canvas, const Layout& layout, const HudText& text,
                      const ViewState& view, const HudScene& scene) {
  const float u = layout.unit;
  draw_caption(canvas, layout.b_scan, text.b_scan, u);
  draw_caption(canvas, layout.en_face, text.en_face, u);
  draw_caption(canvas, layout.scope, text.scope, u);
  const ShownPictures& shown = scene.shown;
  if (shown.volume) {
    if (shown.b_scan == pipeline::BScanState::missing)
      draw_words_within(canvas, layout.b_scan.picture, palette::warning, "B-scan missing", u);
    if (shown.b_scan == pipeline::BScanState::saturated)
      canvas.frame(layout.b_scan.picture, palette::warning, 2 * u);
    draw_panel_scale(canvas, layout.b_scan.picture, shown.geometry.a_mm(), u);
    draw_panel_scale(canvas, layout.en_face.picture, shown.geometry.a_mm(), u);
    draw_position_line(canvas, layout.en_face.picture, view, shown.geometry.b_scans, u);
  }
  if (shown.scope && scene.scan_field && !text.scope_stale)
    draw_scan_field(canvas, layout.scope.picture, *scene.scan_field, u);
}

} // namespace octascope::ui
