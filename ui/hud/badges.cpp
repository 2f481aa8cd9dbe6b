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
  case BadgeKind::whose: return {palette::replay, false};
  case BadgeKind::simulated: return {palette::simulated, false};
  case BadgeKind::waiting: return {palette::quiet_text, false};
  case BadgeKind::stale: return {palette::warning, true};
  case BadgeKind::veiled: return {palette::alarm, true};
  case BadgeKind::frozen: return {palette::frozen, true};
  case BadgeKind::configuration:
  case BadgeKind::calibration:
  case BadgeKind::unregistered: return {palette::warning, false};
  case BadgeKind::incomplete: return {palette::warning, false};
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
  case BadgeKind::whose: // a card
    canvas.frame({static_cast<int>(centre.x - half), static_cast<int>(centre.y - half * 0.75F),
                  static_cast<int>(size), static_cast<int>(size * 0.75F)},
                 ink, size * 0.12F, 0);
    canvas.line({centre.x - half * 0.5F, centre.y}, {centre.x + half * 0.5F, centre.y}, ink,
                size * 0.12F);
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
  }
}

bool is_small(BadgeKind kind) {
  return kind == BadgeKind::incomplete || kind == BadgeKind::configuration ||
         kind == BadgeKind::calibration || kind == BadgeKind::whose;
}

// What must be seen at once is larger than what explains it.
TextStyle style_of(BadgeKind kind) {
  return is_small(kind) ? TextStyle::body : TextStyle::badge;
}

float sign_size(float text_height) {
  return text_height * 0.68F;
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
  draw_sign(canvas, badge.kind, {x + 13 * u + sign / 2, middle}, sign, ink);
  canvas.text({x + 22 * u + sign, middle - text_height / 2}, style, ink, badge.text.view());
}

} // namespace

// Row by row; smaller ones together, in the middle of a row's height.
BadgePlaces place_badges(const Canvas& canvas, const Layout& layout, const HudText& text) {
  const float u = layout.unit;
  const auto padded = [&](TextStyle style) {
    return static_cast<int>(canvas.text_height(style) + 10 * u);
  };
  const auto gap = static_cast<int>(10 * u);
  const int row = padded(TextStyle::badge);
  int x = layout.marks.x;
  int y = layout.marks.y;
  int row_height = row;
  BadgePlaces places{};
  const auto width_of = [&](const Badge& badge) {
    const TextStyle style = style_of(badge.kind);
    return static_cast<int>(canvas.text_width(style, badge.text.view()) +
                            sign_size(canvas.text_height(style)) + 36 * u);
  };
  int small_ones = 0;
  for (std::size_t i = 0; i < text.badge_count; ++i)
    if (is_small(text.badges[i].kind))
      small_ones += width_of(text.badges[i]) + gap;
  for (std::size_t i = 0; i < text.badge_count; ++i) {
    const Badge& badge = text.badges[i];
    if (badge.kind == BadgeKind::unregistered && !layout.view_frame.empty()) {
      places[i] = {x, y, 0, 0}; // said in the small volume itself: vessel_marks.cpp
      continue;
    }
    const int width = width_of(badge);
    const int height = padded(style_of(badge.kind));
    const bool first_small = is_small(badge.kind) && (i == 0 || !is_small(text.badges[i - 1].kind));
    const int needed = first_small ? small_ones - gap : width;
    if (x > layout.marks.x && x + needed > layout.marks.right()) {
      x = layout.marks.x;
      y += row_height + gap / 2;
      row_height = height;
    }
    places[i] = {x, y + (row_height - height) / 2, width, height};
    x += width + gap;
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
