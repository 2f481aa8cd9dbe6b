#include <algorithm>

#include "ui/hud/hud.h"

namespace octascope::ui {

namespace {

struct BadgeLook {
  Colour colour;
  bool filled;
};

// REPLAY, STALE, FROZEN and SIMULATED differ in colour, in filling and in the sign before the word.
BadgeLook look_of(BadgeKind kind) {
  switch (kind) {
  case BadgeKind::replay: return {palette::replay, true};
  case BadgeKind::simulated: return {palette::simulated, false};
  case BadgeKind::waiting: return {palette::quiet_text, false};
  case BadgeKind::stale: return {palette::warning, true};
  case BadgeKind::veiled: return {palette::alarm, true};
  case BadgeKind::frozen: return {palette::frozen, true};
  case BadgeKind::configuration:
  case BadgeKind::calibration:
  case BadgeKind::unregistered: return {palette::warning, false};
  case BadgeKind::incomplete: return {palette::warning, false};
  case BadgeKind::cut: return {palette::accent, false};
  case BadgeKind::rolling: return {palette::seam, false};
  }
  return {palette::text, false};
}

void draw_sign(Canvas& canvas, BadgeKind kind, glm::vec2 centre, float size, Colour ink) {
  const float half = size / 2;
  switch (kind) {
  case BadgeKind::replay: // two arrow-heads to the left: wound back
    for (const float tip : {-1.0F, 0.0F}) {
      const glm::vec2 at{centre.x + tip * half, centre.y};
      canvas.quad({at, glm::vec2{at.x + half, centre.y - half * 0.8F},
                   glm::vec2{at.x + half, centre.y},
                   glm::vec2{at.x + half, centre.y + half * 0.8F}},
                  ink);
    }
    break;
  case BadgeKind::frozen: // two bars: paused
    for (const float side : {-1.0F, 1.0F})
      canvas.line({centre.x + side * half * 0.5F, centre.y - half},
                  {centre.x + side * half * 0.5F, centre.y + half}, ink, size * 0.28F);
    break;
  case BadgeKind::stale:
  case BadgeKind::veiled: // a clock
    canvas.ring(centre, half, ink, size * 0.15F);
    canvas.line(centre, {centre.x, centre.y - half * 0.7F}, ink, size * 0.14F);
    canvas.line(centre, {centre.x + half * 0.55F, centre.y}, ink, size * 0.14F);
    break;
  case BadgeKind::simulated:
    canvas.ring(centre, half, ink, size * 0.15F);
    canvas.dot(centre, half * 0.4F, ink);
    break;
  case BadgeKind::waiting: canvas.ring(centre, half, ink, size * 0.15F); break;
  case BadgeKind::configuration: // a page, with a line struck
    canvas.frame({static_cast<int>(centre.x - half * 0.75F), static_cast<int>(centre.y - half),
                  static_cast<int>(size * 0.75F), static_cast<int>(size)},
                 ink, size * 0.13F, 0);
    canvas.line({centre.x - half, centre.y + half}, {centre.x + half, centre.y - half}, ink,
                size * 0.13F);
    break;
  case BadgeKind::calibration: // two rulers of unequal divisions
    for (const float side : {-1.0F, 1.0F}) {
      const float y = centre.y + side * half * 0.35F;
      canvas.line({centre.x - half, y}, {centre.x + half, y}, ink, size * 0.1F);
      for (int mark = 0; mark < (side < 0 ? 4 : 3); ++mark) {
        const float x =
            centre.x - half +
            (0.1F + static_cast<float>(mark) * (side < 0 ? 0.3F : 0.43F)) * size * 0.95F;
        canvas.line({x, y}, {x, y + side * half * 0.6F}, ink, size * 0.1F);
      }
    }
    break;
  case BadgeKind::unregistered: // two crosses that do not meet
    for (const float side : {-1.0F, 1.0F}) {
      const glm::vec2 at{centre.x + side * half * 0.42F, centre.y + side * half * 0.42F};
      canvas.line({at.x - half * 0.6F, at.y}, {at.x + half * 0.6F, at.y}, ink, size * 0.13F);
      canvas.line({at.x, at.y - half * 0.6F}, {at.x, at.y + half * 0.6F}, ink, size * 0.13F);
    }
    break;
  case BadgeKind::incomplete:
    canvas.line({centre.x, centre.y - half}, {centre.x, centre.y + half * 0.35F}, ink, size * 0.2F);
    canvas.dot({centre.x, centre.y + half * 0.85F}, size * 0.13F, ink);
    break;
  case BadgeKind::cut: // a box, half of it gone
    canvas.frame({static_cast<int>(centre.x - half), static_cast<int>(centre.y - half),
                  static_cast<int>(half), static_cast<int>(size)},
                 ink, size * 0.13F, 0);
    canvas.line({centre.x + half * 0.5F, centre.y - half},
                {centre.x + half * 0.5F, centre.y + half}, ink, size * 0.06F);
    break;
  case BadgeKind::rolling: // a line that goes to the right
    canvas.line({centre.x - half * 0.5F, centre.y - half},
                {centre.x - half * 0.5F, centre.y + half}, ink, size * 0.13F);
    for (const float side : {-1.0F, 1.0F})
      canvas.line({centre.x + half, centre.y},
                  {centre.x + half * 0.2F, centre.y + side * half * 0.6F}, ink, size * 0.1F);
    break;
  }
}

bool is_small(BadgeKind kind) {
  return kind == BadgeKind::incomplete || kind == BadgeKind::configuration ||
         kind == BadgeKind::calibration || kind == BadgeKind::cut || kind == BadgeKind::rolling;
}

// What must be seen at once is larger than what explains it.
TextStyle style_of(BadgeKind kind) {
  return is_small(kind)                    ? TextStyle::label
         : kind == BadgeKind::unregistered ? TextStyle::value
                                           : TextStyle::badge;
}

float sign_size(float text_height) {
  return text_height * 0.68F;
}

// The word, and what is said smaller behind it in two lines: date and time.
struct BadgeWords {
  std::string_view word;
  std::string_view above;
  std::string_view below;
};

BadgeWords words_of(const Badge& badge) {
  const std::string_view text = badge.text.view();
  const std::size_t first = text.find(' ');
  if (badge.kind != BadgeKind::replay || first == std::string_view::npos)
    return {text, {}, {}};
  const std::string_view rest = text.substr(first + 1);
  const std::size_t second = std::min(rest.find(' '), rest.size());
  return {text.substr(0, first), rest.substr(0, second),
          rest.substr(std::min(second + 1, rest.size()))};
}

float width_behind(const Canvas& canvas, const BadgeWords& words, float u) {
  if (words.above.empty())
    return 0;
  return 12 * u + std::max(canvas.text_width(TextStyle::label, words.above),
                           canvas.text_width(TextStyle::label, words.below));
}

void draw_badge(Canvas& canvas, const Badge& badge, const Rect& plate, float u) {
  const BadgeLook look = look_of(badge.kind);
  const TextStyle style = style_of(badge.kind);
  const float rounding = 5 * u;
  canvas.plate(plate, look.filled ? look.colour : palette::panel, rounding);
  if (!look.filled)
    canvas.frame(plate, look.colour, 2 * u, rounding);
  const Colour ink = look.filled ? palette::ink : look.colour;
  const float text_height = canvas.text_height(style);
  const float sign = sign_size(text_height);
  const auto x = static_cast<float>(plate.x);
  const float middle = static_cast<float>(plate.y) + static_cast<float>(plate.height) / 2;
  draw_sign(canvas, badge.kind, {x + 10 * u + sign / 2, middle}, sign, ink);
  const BadgeWords words = words_of(badge);
  const float left = x + 17 * u + sign;
  const float width = canvas.text({left, middle - text_height / 2}, style, ink, words.word);
  const float pitch = 0.84F * canvas.text_height(TextStyle::label); // digits have no descenders
  const float behind = left + width + 12 * u;
  canvas.text({behind, middle - 1.07F * pitch}, TextStyle::label, ink, words.above);
  canvas.text({behind, middle - 0.12F * pitch}, TextStyle::label, ink, words.below);
}

} // namespace

// Row by row; of the smaller ones, two in the height of a large one, or one with more room around its word.
// What finds no room in the row above framed pictures goes into the upper part of the large one.
BadgePlaces place_badges(const Canvas& canvas, const Layout& layout, const HudText& text) {
  const float u = layout.unit;
  const auto gap = static_cast<int>(4 * u);
  const auto tight = static_cast<int>(2 * u); // between the small ones of a row
  const auto height_with = [&](TextStyle style, float spare) {
    return static_cast<int>(canvas.text_height(style) + spare * u);
  };
  const int stacked = height_with(TextStyle::label, -2); // letters have room in their line
  const auto height_of = [&](TextStyle style) { return height_with(style, 4); };
  const auto width_of = [&](const Badge& badge) {
    const TextStyle style = style_of(badge.kind);
    const BadgeWords words = words_of(badge);
    return static_cast<int>(canvas.text_width(style, words.word) + width_behind(canvas, words, u) +
                            sign_size(canvas.text_height(style)) + 27 * u);
  };
  const int row = std::max(height_of(TextStyle::badge), 2 * stacked + tight);
  const bool framed = layout.kind != LayoutKind::volume;
  Rect room = layout.marks;
  int x = room.x;
  int y = room.y;
  int row_height = 0;
  const auto next_row = [&] {
    if (framed && room == layout.marks) {
      room = layout.large;
      room.x += 2 * gap;
      room.width -= 4 * gap;
      y = room.y + 2 * gap;
    } else {
      y += row_height + gap;
    }
    row_height = 0;
    x = room.x;
  };
  BadgePlaces places{};
  Rect* lone = nullptr; // a small one, under which another one finds room
  for (std::size_t i = 0; i < text.badge_count; ++i) {
    const Badge& badge = text.badges[i];
    places[i] = {layout.marks.x, layout.marks.y, 0, 0};
    if (badge.kind == BadgeKind::unregistered && framed)
      continue; // said in the small volume itself: vessel_marks.cpp
    const int width = width_of(badge);
    const int height = height_of(style_of(badge.kind));
    const bool small = is_small(badge.kind);
    if (small && lone != nullptr && lone->x + width <= room.right()) {
      lone->y = y;
      lone->height = stacked;
      places[i] = {lone->x, y + stacked + tight, width, stacked};
      x = lone->x + std::max(lone->width, width) + 2 * gap;
      lone = nullptr;
      continue;
    }
    if (x > room.x && x + width > room.right())
      next_row();
    const bool told = badge.kind == BadgeKind::unregistered ||
                      badge.kind == BadgeKind::incomplete || badge.kind == BadgeKind::cut ||
                      badge.kind == BadgeKind::rolling;
    if (told && (room != layout.marks || y + height > room.bottom()))
      continue; // the status bar says it, too; a cut is seen, and so is a seam
    places[i] = {x, y, width, height};
    // Beside a large one, whose middle is its own.
    lone = small && row_height >= row ? &places[i] : nullptr;
    if (lone != nullptr)
      lone->y += (height_of(TextStyle::badge) - height) / 2;
    row_height = std::max(row_height, style_of(badge.kind) == TextStyle::badge ? row : height);
    x += width + 2 * gap;
  }
  return places;
}

void draw_badges(Canvas& canvas, const Layout& layout, const HudText& text) {
  const BadgePlaces places = place_badges(canvas, layout, text);
  for (std::size_t i = 0; i < text.badge_count; ++i)
    if (!places[i].empty())
      draw_badge(canvas, text.badges[i], places[i], layout.unit);
}

void draw_liveness_marks(Canvas& canvas, const Layout& layout, Liveness liveness) {
  if (liveness == Liveness::waiting || liveness == Liveness::live)
    return;
  const float u = layout.unit;
  for (const Rect& rect :
       {layout.view, layout.b_scan.picture, layout.crossed.picture, layout.en_face.picture}) {
    if (rect.empty())
      continue;
    if (liveness == Liveness::veiled) {
      canvas.plate(rect, palette::background.faded(205));
      canvas.stripes(rect, palette::alarm.faded(70), 28 * u, 2 * u);
    }
    const Colour colour = liveness == Liveness::frozen     ? palette::frozen
                          : liveness == Liveness::replayed ? palette::replay
                          : liveness == Liveness::stale    ? palette::warning
                                                           : palette::alarm;
    canvas.frame(rect, colour, (liveness == Liveness::frozen ? 3.0F : 4.0F) * u);
  }
}

} // namespace octascope::ui
