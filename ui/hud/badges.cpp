#include "ui/hud/hud.h"

namespace octascope::ui {

namespace {

struct BadgeLook {
  Colour colour;
  bool filled;
};

// STALE, FROZEN and SIMULATED differ in colour, in filling and in the sign before the word.
BadgeLook look_of(BadgeKind kind) {
  switch (kind) {
  case BadgeKind::simulated: return {palette::simulated, false};
  case BadgeKind::waiting: return {palette::quiet_text, false};
  case BadgeKind::stale: return {palette::warning, true};
  case BadgeKind::veiled: return {palette::alarm, true};
  case BadgeKind::frozen: return {palette::frozen, true};
  case BadgeKind::incomplete: return {palette::warning, false};
  }
  return {palette::text, false};
}

void draw_sign(Canvas& canvas, BadgeKind kind, glm::vec2 centre, float size, Colour ink) {
  const float half = size / 2;
  switch (kind) {
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
  case BadgeKind::incomplete:
    canvas.line({centre.x, centre.y - half}, {centre.x, centre.y + half * 0.35F}, ink, size * 0.2F);
    canvas.dot({centre.x, centre.y + half * 0.85F}, size * 0.13F, ink);
    break;
  }
}

} // namespace

void draw_badges(Canvas& canvas, const Layout& layout, const HudText& text) {
  const float u = layout.unit;
  const float text_height = canvas.text_height(TextStyle::badge);
  const auto height = static_cast<int>(text_height + 14 * u);
  const auto start = static_cast<float>(layout.view.x) + 16 * u;
  float x = start;
  float y = static_cast<float>(layout.view.y) + 16 * u;
  for (std::size_t i = 0; i < text.badge_count; ++i) {
    const Badge& badge = text.badges[i];
    const BadgeLook look = look_of(badge.kind);
    const float sign = text_height * 0.68F;
    const float width = canvas.text_width(TextStyle::badge, badge.text.view()) + sign + 36 * u;
    if (x > start && x + width > static_cast<float>(layout.view.right()) - 16 * u) {
      x = start;
      y += static_cast<float>(height) + 8 * u;
    }
    const Rect plate{static_cast<int>(x), static_cast<int>(y), static_cast<int>(width), height};
    const float rounding = 5 * u;
    canvas.plate(plate, look.filled ? look.colour : palette::panel, rounding);
    if (!look.filled)
      canvas.frame(plate, look.colour, 2 * u, rounding);
    const Colour ink = look.filled ? palette::ink : look.colour;
    const float middle = y + static_cast<float>(height) / 2;
    draw_sign(canvas, badge.kind, {x + 13 * u + sign / 2, middle}, sign, ink);
    canvas.text({x + 22 * u + sign, middle - text_height / 2}, TextStyle::badge, ink,
                badge.text.view());
    x += width + 10 * u;
  }
}

void draw_liveness_marks(Canvas& canvas, const Layout& layout, Liveness liveness) {
  const float u = layout.unit;
  const auto veil = [&](const Rect& rect) {
    canvas.plate(rect, palette::background.faded(205));
    canvas.stripes(rect, palette::alarm.faded(70), 28 * u, 2 * u);
  };
  switch (liveness) {
  case Liveness::waiting:
  case Liveness::live: break;
  case Liveness::stale:
    for (const Rect* rect : {&layout.view, &layout.b_scan.picture, &layout.en_face.picture})
      canvas.frame(*rect, palette::warning, 4 * u);
    break;
  case Liveness::veiled:
    for (const Rect* rect : {&layout.view, &layout.b_scan.picture, &layout.en_face.picture}) {
      veil(*rect);
      canvas.frame(*rect, palette::alarm, 4 * u);
    }
    break;
  case Liveness::frozen:
    for (const Rect* rect : {&layout.view, &layout.b_scan.picture, &layout.en_face.picture})
      canvas.frame(*rect, palette::frozen, 2 * u);
    break;
  }
}

} // namespace octascope::ui
