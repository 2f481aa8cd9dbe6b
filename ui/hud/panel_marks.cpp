#include <algorithm>
#include <cmath>

#include "ui/hud/hud.h"

namespace octascope::ui {

namespace {

Colour colour_of(Tone tone) {
  return tone == Tone::warning ? palette::warning : palette::quiet_text;
}

// Where both have no room, a warning wins over the title and the title over a quiet note.
void draw_caption(Canvas& canvas, const Rect& room, const Caption& caption, float unit) {
  if (room.empty())
    return;
  const float title = canvas.text_width(TextStyle::body, caption.title.view());
  const float note = canvas.text_width(TextStyle::label, caption.note.view());
  const bool both = title + note + 16 * unit <= static_cast<float>(room.width);
  const auto y = [&](TextStyle style) {
    return static_cast<float>(room.y) +
           (static_cast<float>(room.height) - canvas.text_height(style)) / 2;
  };
  if (both || caption.note_tone != Tone::warning)
    canvas.text({static_cast<float>(room.x) + 2 * unit, y(TextStyle::body)}, TextStyle::body,
                palette::text, caption.title.view());
  if (both || caption.note_tone == Tone::warning)
    canvas.text({static_cast<float>(room.right()) - 2 * unit - note, y(TextStyle::label)},
                TextStyle::label, colour_of(caption.note_tone), caption.note.view());
}

// In the upper quarter of the picture.
void draw_words_over(Canvas& canvas, const Rect& rect, Colour colour, std::string_view words,
                     float unit) {
  const float width = canvas.text_width(TextStyle::body, words);
  const float height = canvas.text_height(TextStyle::body);
  const float x = static_cast<float>(rect.x) + (static_cast<float>(rect.width) - width) / 2;
  const float y = static_cast<float>(rect.y) + 10 * unit;
  canvas.plate({static_cast<int>(x - 12 * unit), static_cast<int>(y - 4 * unit),
                static_cast<int>(width + 24 * unit), static_cast<int>(height + 8 * unit)},
               palette::panel, 4 * unit);
  canvas.text({x, y}, TextStyle::body, colour, words);
}

void draw_panel_scale(Canvas& canvas, const Rect& rect, double width_mm, float unit,
                      std::string_view medium = {}) {
  draw_scale_bar(
      canvas, {static_cast<float>(rect.x) + 8 * unit, static_cast<float>(rect.bottom()) - 8 * unit},
      width_mm / rect.width, std::min(0.4F * static_cast<float>(rect.width), 240 * unit), unit,
      medium);
}

} // namespace

FixedText<8> medium_words(const std::optional<double>& refractive_index) {
  constexpr double told_apart = 0.005; // from air, with two digits
  FixedText<8> words;
  if (!refractive_index)
    words.format("n ?");
  else if (*refractive_index < 1 + told_apart)
    words.format("in air");
  else
    words.format("n {:.2f}", *refractive_index);
  return words;
}

double round_scale_length_mm(double longest_mm) {
  const double power = std::pow(10.0, std::floor(std::log10(longest_mm)));
  for (const double digit : {5.0, 2.0})
    if (digit * power <= longest_mm)
      return digit * power;
  return power;
}

void draw_scale_bar(Canvas& canvas, glm::vec2 left_bottom, double mm_per_pixel, float most_pixels,
                    float unit, std::string_view medium) {
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
  const float y = from.y - 3 * unit - canvas.text_height(TextStyle::label);
  canvas.shadowed_text({from.x, y}, TextStyle::label, palette::text, words.view());
  if (medium.empty())
    return;
  const float width = canvas.text_width(TextStyle::label, words.view());
  canvas.shadowed_text({from.x + width + 10 * unit, y}, TextStyle::label, palette::quiet_text,
                       medium);
}

void draw_panel_marks(Canvas& canvas, const Layout& layout, const HudText& text,
                      const ViewState& view, const HudScene& scene) {
  const float u = layout.unit;
  draw_caption(canvas, layout.view_title, text.volume, u);
  draw_caption(canvas, layout.b_scan.title, text.b_scan, u);
  draw_caption(canvas, layout.crossed.title, text.crossed, u);
  draw_caption(canvas, layout.en_face.title, text.en_face, u);
  draw_caption(canvas, layout.scope.title, text.scope, u);
  const ShownPictures& shown = scene.shown;
  const Crop& crop = scene.crop;
  if (shown.volume && layout.b_scan.shown()) {
    const Rect& picture = layout.b_scan.picture;
    if (shown.b_scan == pipeline::BScanState::missing)
      draw_words_over(canvas, picture, palette::warning, "B-scan missing", u);
    if (shown.b_scan == pipeline::BScanState::saturated)
      canvas.frame(picture, palette::warning, 2 * u);
    draw_panel_scale(canvas, picture, crop.a_mm(shown.geometry), u,
                     medium_words(shown.geometry.refractive_index).view());
  }
  if (shown.volume && layout.crossed.shown())
    draw_panel_scale(canvas, layout.crossed.picture, crop.b_mm(shown.geometry), u,
                     medium_words(shown.geometry.refractive_index).view());
  if (shown.volume && layout.en_face.shown())
    draw_panel_scale(canvas, layout.en_face.picture, crop.a_mm(shown.geometry), u);
  if (shown.volume)
    draw_scan_marks(canvas, layout, view, scene);
  if (shown.scope && layout.scope.shown() && text.scope_stale)
    canvas.frame(layout.scope.picture, palette::warning, 4 * u);
  if (shown.scope && layout.scope.shown() && scene.scan_field && !text.scope_stale)
    draw_scan_field(canvas, layout.scope.picture, *scene.scan_field, view, scene.shown, u);
}

} // namespace octascope::ui
