#include <algorithm>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "ui/hud/hud.h"

namespace octascope::ui {

namespace {

Colour colour_of(Tone tone) {
  return tone == Tone::warning ? palette::warning : palette::quiet_text;
}

// What hue is how deep, at the line's right end, as long as there is room. Returns the width that it
// takes.
float draw_hues(Canvas& canvas, const Rect& room, std::string_view deepest, float unit) {
  const float letters = canvas.text_height(TextStyle::label);
  const auto width_of = [&](std::string_view words) {
    return canvas.text_width(TextStyle::label, words);
  };
  const float begin = width_of("0") + 6 * unit;
  const float end = 6 * unit + width_of("deep");
  const float needed = width_of(deepest) + 6 * unit;
  const float most = static_cast<float>(room.width) - 2 * unit;
  const bool in_full = needed + begin + end + 56 * unit <= most;
  const float hues = (in_full ? 56 : 36) * unit;
  const float width = needed + hues + (in_full ? begin + end : 0);
  if (width > most)
    return 0;
  float x = static_cast<float>(room.right()) - 2 * unit - width;
  const float middle = static_cast<float>(room.y) + static_cast<float>(room.height) / 2;
  const auto write = [&](std::string_view words) {
    canvas.text({x, middle - letters / 2}, TextStyle::label, palette::quiet_text, words);
    x += width_of(words);
  };
  if (in_full) {
    write("0");
    x += 6 * unit;
  }
  constexpr int pieces = 28;
  for (int i = 0; i < pieces; ++i, x += hues / pieces)
    canvas.bar({x, middle - 4 * unit}, {x + hues / pieces, middle + 4 * unit},
               depth_hue((static_cast<float>(i) + 0.5F) / pieces));
  x += 6 * unit;
  write(deepest);
  if (in_full) {
    x += 6 * unit;
    write("deep");
  }
  return width;
}

// Where both have no room, a warning wins over the title and the title over a quiet note.
void draw_caption(Canvas& canvas, Rect room, const Caption& caption, float unit) {
  if (room.empty())
    return;
  const float title = canvas.text_width(TextStyle::label, caption.title.view());
  const float note = canvas.text_width(TextStyle::label, caption.note.view());
  if (!caption.deepest.view().empty()) {
    const auto beside_title = static_cast<int>(title + 12 * unit);
    const Rect there{room.x + beside_title, room.y, room.width - beside_title, room.height};
    const float hues = draw_hues(canvas, there, caption.deepest.view(), unit);
    room.width -= static_cast<int>(hues + (hues > 0 ? 12 * unit : 0));
  }
  const bool both = title + note + 16 * unit <= static_cast<float>(room.width);
  const auto y = [&](TextStyle style) {
    return static_cast<float>(room.y) +
           (static_cast<float>(room.height) - canvas.text_height(style)) / 2;
  };
  if (both || caption.note_tone != Tone::warning)
    canvas.text({static_cast<float>(room.x) + 2 * unit, y(TextStyle::label)}, TextStyle::label,
                palette::text, caption.title.view());
  if (both || caption.note_tone == Tone::warning)
    canvas.text({static_cast<float>(room.right()) - 2 * unit - note, y(TextStyle::label)},
                TextStyle::label, colour_of(caption.note_tone), caption.note.view());
}

// In the upper quarter of the picture.
void draw_words_over(Canvas& canvas, const Rect& rect, Colour colour, std::string_view words,
                     float unit) {
  const float width = canvas.text_width(TextStyle::label, words);
  const float height = canvas.text_height(TextStyle::label);
  const float x = static_cast<float>(rect.x) + (static_cast<float>(rect.width) - width) / 2;
  const float y = static_cast<float>(rect.y) + 10 * unit;
  canvas.plate({static_cast<int>(x - 12 * unit), static_cast<int>(y - 4 * unit),
                static_cast<int>(width + 24 * unit), static_cast<int>(height + 8 * unit)},
               palette::panel, 4 * unit);
  canvas.text({x, y}, TextStyle::label, colour, words);
}

void draw_panel_scale(Canvas& canvas, const Rect& rect, double mm_per_pixel, float unit,
                      std::string_view medium = {}) {
  if (static_cast<float>(rect.height) < 144 * unit) // it would reach the middle
    return;
  draw_scale_bar(
      canvas, {static_cast<float>(rect.x) + 8 * unit, static_cast<float>(rect.bottom()) - 8 * unit},
      mm_per_pixel, std::min(0.3F * static_cast<float>(rect.width), 240 * unit), unit, medium);
}

// Along its first B-scan, which is as long as the volume is wide.
double mm_per_pixel_of(const Rect& rect, const ScanField& field, double a_mm) {
  const glm::vec2 along = to_pixels(rect, field.corners[1]) - to_pixels(rect, field.corners[0]);
  return a_mm / std::max(1.0, static_cast<double>(glm::length(along)));
}

// Beside the picture's middle.
bool has_room(const Canvas& canvas, const Rect& rect, std::string_view words) {
  return canvas.text_width(TextStyle::value, words) < 0.22F * static_cast<float>(rect.width);
}

// Inside the picture's border, where the line from `centre` in that direction meets it.
void draw_side(Canvas& canvas, const Rect& rect, glm::vec2 centre, glm::vec2 direction,
               std::string_view words, float unit) {
  const glm::vec2 half =
      glm::vec2{canvas.text_width(TextStyle::value, words), canvas.text_height(TextStyle::value)} /
      2.0F;
  const glm::vec2 low = glm::vec2{rect.x, rect.y} + half + 4 * unit;
  const glm::vec2 high = glm::vec2{rect.right(), rect.bottom()} - half - 4 * unit;
  float reach = 1e9F;
  for (const int axis : {0, 1})
    if (std::abs(direction[axis]) > 1e-3F)
      reach = std::min(reach,
                       ((direction[axis] > 0 ? high : low)[axis] - centre[axis]) / direction[axis]);
  glm::vec2 at = glm::clamp(centre + std::max(reach, 0.0F) * direction, low, high);
  if (high.y - at.y < 2 * half.y) // beside the scale
    at.x = std::max(at.x, std::min(high.x, static_cast<float>(rect.x) + 106 * unit + half.x));
  canvas.shadowed_text(at - half, TextStyle::value, palette::text, words);
}

// Where x and y point to in a picture that shows the scan from above.
struct Directions {
  glm::vec2 centre;
  glm::vec2 x;
  glm::vec2 y;
};

// Where all four find room beside the middle and the scale.
void draw_sides(Canvas& canvas, const Rect& rect, const Directions& to, const HudText& text,
                float unit) {
  if (static_cast<float>(rect.width) < 140 * unit || static_cast<float>(rect.height) < 136 * unit)
    return;
  const AxisEnds& ends = text.ends;
  const bool words = has_room(canvas, rect, to_string(Side::temporal)); // the longest
  // At the far end, where no side is said, the axis's name.
  const auto draw = [&](glm::vec2 direction, const std::optional<Side>& side,
                        std::string_view axis) {
    const std::string_view end = !side ? axis : words ? to_string(*side) : letter_of(*side);
    draw_side(canvas, rect, to.centre, direction, end, unit);
  };
  const auto name = [&](std::size_t axis, std::string_view letter) {
    const std::string& own = text.labels.names[axis];
    return own.empty() || !has_room(canvas, rect, own) ? letter : std::string_view{own};
  };
  draw(-to.x, ends.x_begin, {});
  draw(to.x, ends.x_end, name(0, "x"));
  draw(-to.y, ends.y_begin, {});
  draw(to.y, ends.y_end, name(1, "y"));
}

Directions directions_in(const Rect& rect, const ScanField& field) {
  std::array<glm::vec2, 4> at;
  std::ranges::transform(field.corners, at.begin(),
                         [&](const ScanField::Corner& corner) { return to_pixels(rect, corner); });
  const auto towards = [](glm::vec2 from, glm::vec2 to) {
    return (to - from) / std::max(1.0F, glm::length(to - from));
  };
  return {(at[0] + at[1] + at[2] + at[3]) / 4.0F, towards(at[0], at[1]), towards(at[0], at[3])};
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
  const double a_mm = scene.crop.a_mm(shown.geometry);
  const FixedText<8> medium = medium_words(shown.geometry.refractive_index);
  if (shown.volume && layout.b_scan.shown()) {
    const Rect& picture = layout.b_scan.picture;
    if (shown.b_scan == pipeline::BScanState::missing)
      draw_words_over(canvas, picture, palette::warning, "B-scan missing", u);
    if (shown.b_scan == pipeline::BScanState::saturated)
      canvas.frame(picture, palette::warning, 2 * u);
    draw_panel_scale(canvas, picture, a_mm / picture.width, u, medium.view());
  }
  if (shown.volume && layout.crossed.shown()) {
    const Rect& picture = layout.crossed.picture;
    draw_panel_scale(canvas, picture, scene.crop.b_mm(shown.geometry) / picture.width, u,
                     medium.view());
  }
  if (shown.volume && layout.en_face.shown()) {
    const Rect& picture = layout.en_face.picture;
    draw_panel_scale(canvas, picture, a_mm / picture.width, u);
    const glm::vec2 centre{static_cast<float>(picture.x) + static_cast<float>(picture.width) / 2,
                           static_cast<float>(picture.y) + static_cast<float>(picture.height) / 2};
    draw_sides(canvas, picture, {centre, {1, 0}, {0, 1}}, text, u);
  }
  if (shown.volume)
    draw_scan_marks(canvas, layout, view, scene, text.window_changing ? layout.histogram : Rect{});
  if (shown.scope && layout.scope.shown() && text.scope_stale)
    canvas.frame(layout.scope.picture, palette::warning, 4 * u);
  if (shown.scope && layout.scope.shown() && scene.scan_field && !text.scope_stale) {
    const Rect& picture = layout.scope.picture;
    draw_scan_field(canvas, picture, *scene.scan_field, view, shown, u);
    if (shown.volume)
      draw_panel_scale(canvas, picture,
                       mm_per_pixel_of(picture, *scene.scan_field, shown.geometry.a_mm()), u);
    draw_sides(canvas, picture, directions_in(picture, *scene.scan_field), text, u);
  }
}

} // namespace octascope::ui
