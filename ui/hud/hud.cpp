#include "ui/hud/hud.h"

#include <algorithm>

#include "ui/hud/legend.h"
#include "ui/hud/two_lines.h"

namespace octascope::ui {

namespace {

// What is on record, and how finely the volume is drawn: quiet, at the foot of a large volume, else
// beside the badges; the fineness is then in the volume's caption.
void draw_source(Canvas& canvas, const Layout& layout, const HudText& text) {
  const float u = layout.unit;
  const float height = canvas.text_height(TextStyle::label);
  const auto draw = [&](float right, float y, std::string_view words) {
    canvas.shadowed_text({right - canvas.text_width(TextStyle::label, words), y}, TextStyle::label,
                         palette::quiet_text, words);
  };
  if (layout.view_frame.empty()) {
    const float y = static_cast<float>(layout.view.bottom()) - 12 * u - height;
    float right = static_cast<float>(layout.view.right()) - 16 * u;
    draw(right, y, text.source.view());
    if (!text.source.empty())
      right -= canvas.text_width(TextStyle::label, text.source.view()) + 24 * u;
    draw(right, y, text.reduced.view());
    return;
  }
  float taken = static_cast<float>(layout.marks.x);
  const BadgePlaces places = place_badges(canvas, layout, text);
  for (std::size_t i = 0; i < text.badge_count; ++i)
    taken = std::max(taken, static_cast<float>(places[i].right()));
  const auto right = static_cast<float>(layout.marks.right());
  if (right - canvas.text_width(TextStyle::label, text.source.view()) > taken + 24 * u)
    draw(right, static_cast<float>(layout.marks.y) + 12 * u, text.source.view());
}

void draw_notice(Canvas& canvas, const Layout& layout, const HudText& text) {
  if (text.notice.empty())
    return;
  const float u = layout.unit;
  const Rect& room = layout.notice;
  const float beside = 30 * u; // of the words: the coloured edge, and room to their left and right
  const auto most = static_cast<float>(room.width) - beside;
  const auto width_in = [&](TextStyle style) {
    return [&canvas, style](std::string_view words) { return canvas.text_width(style, words); };
  };
  // What is too long for its line has smaller letters, and a second line above it if it must.
  const std::string_view words = text.notice.view();
  const TextStyle style =
      width_in(TextStyle::value)(words) <= most ? TextStyle::value : TextStyle::label;
  const TwoLines lines = break_to_fit(words, most, width_in(style));
  const float line_height = canvas.text_height(style);
  const bool two = !lines.second.empty();
  const float width =
      std::max(width_in(style)(lines.first), two ? width_in(style)(lines.second) : 0);
  const int height = two ? static_cast<int>(2 * line_height + 14 * u) : room.height;
  const Rect plate{room.x, room.bottom() - height, static_cast<int>(std::min(width, most) + beside),
                   height};
  const Canvas::Clip clip{canvas, plate};
  canvas.plate(plate, palette::plate, 4 * u);
  canvas.plate({plate.x, plate.y, static_cast<int>(5 * u), plate.height}, palette::warning);
  const float x = static_cast<float>(room.x) + 16 * u;
  const float y =
      static_cast<float>(plate.y) + (static_cast<float>(height) - (two ? 2 : 1) * line_height) / 2;
  canvas.text({x, y}, style, palette::text, lines.first);
  if (two)
    canvas.text({x, y + line_height}, style, palette::text, lines.second);
}

} // namespace

void draw_view_scale(Canvas& canvas, const Layout& layout, const HudScene& scene) {
  const Camera& camera = scene.camera;
  const float u = layout.unit;
  const float margin = (layout.view_frame.empty() ? 16 : 8) * u;
  const double mm_per_pixel =
      static_cast<double>(2 * camera.tan_half_height * camera.depth_of(glm::vec3{0})) /
      layout.view.height;
  draw_scale_bar(canvas,
                 {static_cast<float>(layout.view.x) + margin,
                  static_cast<float>(layout.view.bottom()) - margin},
                 mm_per_pixel, 0.2F * static_cast<float>(layout.view.width), u,
                 medium_words(scene.shown.geometry.refractive_index).view());
}

void draw_hud_ground(Canvas& canvas, const Layout& layout) {
  const float rounding = 4 * layout.unit;
  for (const Panel* panel : {&layout.b_scan, &layout.crossed, &layout.en_face, &layout.scope})
    if (panel->shown())
      canvas.plate(panel->frame, palette::panel, rounding);
  canvas.plate(layout.status_bar, palette::panel);
}

void draw_view_ground(Canvas& canvas, const Layout& layout) {
  if (layout.view_frame.empty())
    return;
  canvas.plate(layout.view_frame, palette::panel, 4 * layout.unit);
  canvas.plate(layout.view, palette::background);
}

void draw_hud(Canvas& canvas, const Layout& layout, const HudText& text, const ViewState& view,
              const HudScene& scene) {
  draw_panel_marks(canvas, layout, text, view, scene);
  if (scene.shown.volume)
    draw_orientation_cube(canvas, layout.cube, scene.camera, layout.unit);
  draw_liveness_marks(canvas, layout, text.liveness);
  if (scene.shown.volume)
    draw_view_scale(canvas, layout, scene);
  draw_vessel_marks(canvas, layout, text.vessels);
  draw_source(canvas, layout, text);
  draw_notice(canvas, layout, text);
  draw_badges(canvas, layout, text);
  draw_status_bar(canvas, layout, text);
  if (text.window_changing && scene.levels != nullptr)
    draw_window_histogram(canvas, layout.histogram, *scene.levels, view, layout.unit);
  if (text.legend != nullptr)
    draw_legend(canvas, layout, *text.legend, text.selected);
  draw_echo(canvas, layout, text.echo);
}

} // namespace octascope::ui
