#include "ui/hud/hud.h"

#include "ui/hud/legend.h"

namespace octascope::ui {

void draw_view_scale(Canvas& canvas, const Layout& layout, const HudScene& scene) {
  const Camera& camera = scene.camera;
  const float u = layout.unit;
  const float margin = (layout.view_frame.empty() ? 16 : 8) * u;
  const double mm_per_pixel =
      static_cast<double>(2 * camera.tan_half_height * camera.depth_of(glm::vec3{0})) /
      layout.view.height;
  const FixedText<8> medium = medium_words(scene.shown.geometry.refractive_index);
  const bool fits = canvas.text_width(TextStyle::label, "0.2 mm") +
                        canvas.text_width(TextStyle::label, medium.view()) + 10 * u + 2 * margin <=
                    static_cast<float>(layout.view.width);
  draw_scale_bar(canvas,
                 {static_cast<float>(layout.view.x) + margin,
                  static_cast<float>(layout.view.bottom()) - margin},
                 mm_per_pixel, 0.2F * static_cast<float>(layout.view.width), u,
                 fits ? medium.view() : std::string_view{});
}

void draw_hud_ground(Canvas& canvas, const Layout& layout) {
  const float rounding = 4 * layout.unit;
  for (const Panel* panel : {&layout.b_scan, &layout.crossed, &layout.en_face, &layout.scope})
    if (panel->shown())
      canvas.plate(panel->frame, palette::panel, rounding);
  canvas.plate(layout.status_bar, palette::panel);
  for (const Rect* strip : {&layout.figures, &layout.timing})
    if (!strip->empty())
      canvas.plate(*strip, palette::panel);
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
    draw_orientation_cube(canvas, layout.cube, scene.camera, layout.unit, text);
  draw_liveness_marks(canvas, layout, text.liveness);
  if (scene.shown.volume && !layout.view.empty()) {
    draw_view_scale(canvas, layout, scene);
    draw_depth_scale(canvas, layout, scene);
  }
  draw_vessel_marks(canvas, layout, text.vessels);
  draw_badges(canvas, layout, text);
  draw_status_bar(canvas, layout, text);
  draw_engineers_strip(canvas, layout, text);
  if (text.timing != nullptr)
    draw_timing_diagram(canvas, layout.timing, *text.timing, layout.unit);
  if (text.window_changing && scene.levels != nullptr)
    draw_window_histogram(canvas, layout.histogram, *scene.levels, view, layout.unit);
  if (text.legend != nullptr)
    draw_legend(canvas, layout, *text.legend, text.selected, text.page);
}

} // namespace octascope::ui
