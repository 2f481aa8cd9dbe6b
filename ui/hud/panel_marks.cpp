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

void draw_position_line(Canvas& canvas, const Rect& rect, float share, float unit) {
  const float y = static_cast<float>(rect.y) + static_cast<float>(rect.height) * share;
  const auto left = static_cast<float>(rect.x);
  const auto right = static_cast<float>(rect.right());
  canvas.line({left, y}, {right, y}, palette::accent.faded(150), std::max(1.0F, 1.2F * unit));
  // Short and bright at both ends, where they hide nothing.
  canvas.line({left - 6 * unit, y}, {left + 6 * unit, y}, palette::accent, 3 * unit);
  canvas.line({right - 6 * unit, y}, {right + 6 * unit, y}, palette::accent, 3 * unit);
}

glm::vec2 to_pixels(const Rect& rect, const ScanField::Corner& corner) {
  return {static_cast<float>(rect.x) + corner.x * static_cast<float>(rect.width),
          static_cast<float>(rect.y) + corner.y * static_cast<float>(rect.height)};
}

void draw_scan_field(Canvas& canvas, const Rect& rect, const ScanField& field, float unit) {
  for (std::size_t i = 0; i < field.corners.size(); ++i)
    canvas.line(to_pixels(rect, field.corners[i]),
                to_pixels(rect, field.corners[(i + 1) % field.corners.size()]), palette::accent,
                2 * unit);
  canvas.dot(to_pixels(rect, field.corners[0]), 4 * unit, palette::accent);
}

// Where the B-scan of the panel lies in it.
void draw_position_in_field(Canvas& canvas, const Rect& rect, const ScanField& field, float share,
                            float unit) {
  const auto between = [&](std::size_t from, std::size_t to) {
    const glm::vec2 a = to_pixels(rect, field.corners[from]);
    return a + share * (to_pixels(rect, field.corners[to]) - a);
  };
  const glm::vec2 begin = between(0, 3);
  const glm::vec2 end = between(1, 2);
  canvas.line(begin, end, palette::accent.faded(170), std::max(1.0F, 1.5F * unit));
  for (const glm::vec2 at : {begin, end})
    canvas.dot(at, 3 * unit, palette::accent);
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
  draw_caption(canvas, layout.en_face.title, text.en_face, u);
  draw_caption(canvas, layout.scope.title, text.scope, u);
  const ShownPictures& shown = scene.shown;
  const float share = (static_cast<float>(view.b_scan) + 0.5F) /
                      static_cast<float>(std::max(shown.geometry.b_scans, 1));
  if (shown.volume && layout.b_scan.shown()) {
    const Rect& picture = layout.b_scan.picture;
    if (shown.b_scan == pipeline::BScanState::missing)
      draw_words_over(canvas, picture, palette::warning, "B-scan missing", u);
    if (shown.b_scan == pipeline::BScanState::saturated)
      canvas.frame(picture, palette::warning, 2 * u);
    draw_panel_scale(canvas, picture, shown.geometry.a_mm(), u,
                     medium_words(shown.geometry.refractive_index).view());
  }
  if (shown.volume && layout.en_face.shown()) {
    draw_position_line(canvas, layout.en_face.picture, share, u);
    draw_panel_scale(canvas, layout.en_face.picture, shown.geometry.a_mm(), u);
  }
  if (shown.scope && layout.scope.shown() && text.scope_stale)
    canvas.frame(layout.scope.picture, palette::warning, 4 * u);
  if (shown.scope && layout.scope.shown() && scene.scan_field && !text.scope_stale) {
    const Canvas::Clip clip{canvas, layout.scope.picture};
    draw_scan_field(canvas, layout.scope.picture, *scene.scan_field, u);
    if (shown.volume)
      draw_position_in_field(canvas, layout.scope.picture, *scene.scan_field, share, u);
  }
}

} // namespace octascope::ui
