#include "ui/hud/hud.h"

#include "ui/hud/legend.h"

namespace octascope::ui {

namespace {

void draw_view_texts(Canvas& canvas, const Layout& layout, const HudText& text,
                     const HudScene& scene) {
  const float u = layout.unit;
  const auto left = static_cast<float>(layout.view.x) + 16 * u;
  const auto bottom = static_cast<float>(layout.view.bottom());
  if (scene.shown.volume)
    draw_scale_bar(canvas, {left, bottom - 16 * u}, scene.view_mm_per_pixel, 160 * u, u);
  if (!text.source.empty()) {
    const float width = canvas.text_width(TextStyle::label, text.source.view());
    canvas.text({static_cast<float>(layout.view.right()) - width - 16 * u,
                 bottom - 12 * u - canvas.text_height(TextStyle::label)},
                TextStyle::label, palette::quiet_text, text.source.view());
  }
  if (!text.notice.empty()) {
    const float height = canvas.text_height(TextStyle::value);
    const float y = bottom - 84 * u - height;
    const float width = canvas.text_width(TextStyle::value, text.notice.view());
    const Rect plate{static_cast<int>(left), static_cast<int>(y - 6 * u),
                     static_cast<int>(width + 28 * u), static_cast<int>(height + 12 * u)};
    canvas.plate(plate, palette::panel.faded(235), 4 * u);
    canvas.plate({plate.x, plate.y, static_cast<int>(4 * u), plate.height}, palette::warning);
    canvas.text({left + 16 * u, y}, TextStyle::value, palette::text, text.notice.view());
  }
}

} // namespace

void draw_hud_ground(Canvas& canvas, const Layout& layout) {
  for (const Panel* panel : {&layout.b_scan, &layout.en_face, &layout.scope})
    canvas.plate(panel->frame, palette::panel, 4 * layout.unit);
  canvas.plate(layout.status_bar, palette::panel);
}

void draw_hud(Canvas& canvas, const Layout& layout, const HudText& text, const ViewState& view,
              const HudScene& scene) {
  draw_panel_marks(canvas, layout, text, view, scene);
  draw_liveness_marks(canvas, layout, text.liveness);
  draw_view_texts(canvas, layout, text, scene);
  draw_badges(canvas, layout, text);
  draw_status_bar(canvas, layout, text);
  if (text.legend != nullptr)
    draw_legend(canvas, layout, *text.legend, text.selected);
  draw_echo(canvas, layout, text.echo);
}

} // namespace octascope::ui
