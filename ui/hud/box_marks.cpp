#include <algorithm>

#include "ui/hud/hud.h"
#include "ui/layout/box_edges.h"

namespace octascope::ui {

namespace {

struct Pen {
  Canvas& canvas;
  bool in_front;

  void draw(const auto& edges, Colour colour, float width) const {
    for (const BoxEdge& edge : edges)
      if (edge.visible && edge.in_front == in_front)
        canvas.line(edge.from, edge.to, in_front ? colour : colour.faded(colour.a / 2), width);
  }
};

// The seam as an outline; runs of B-scans that did not come as slabs; of saturated ones, along the box's edges only.
void draw_state_marks(const Pen& pen, const Rect& view, const HudScene& scene, float unit) {
  const auto count = static_cast<float>(scene.states.size());
  std::size_t begin = 0;
  while (begin < scene.states.size()) {
    const pipeline::BScanState state = scene.states[begin];
    std::size_t end = begin + 1;
    while (end < scene.states.size() && scene.states[end] == state)
      ++end;
    const float from = static_cast<float>(begin) / count;
    const float to = static_cast<float>(end) / count;
    begin = end;
    if (state == pipeline::BScanState::good)
      continue;
    if (state == pipeline::BScanState::seam) {
      pen.draw(
          project_slice(scene.camera, scene.extents_mm, SliceAcross::slow, (from + to) / 2, view),
          palette::seam, 2 * unit);
      continue;
    }
    const bool missing = state == pipeline::BScanState::missing;
    pen.draw(project_slow_edges(scene.camera, scene.extents_mm, from, to, view), palette::warning,
             (missing ? 6.0F : 3.0F) * unit);
    if (missing)
      for (const float share : {from, to})
        pen.draw(project_slice(scene.camera, scene.extents_mm, SliceAcross::slow, share, view),
                 palette::warning.faded(150), 1.5F * unit);
  }
}

float thin_line(float unit) {
  return std::max(1.0F, 1.5F * unit);
}

} // namespace

void draw_wire_frame(Canvas& canvas, const Rect& view, const HudScene& scene, float unit,
                     bool in_front) {
  const Canvas::Clip clip{canvas, view};
  Pen{canvas, in_front}.draw(project_box(scene.camera, scene.extents_mm, view), palette::box,
                             thin_line(unit));
}

void draw_box_marks(Canvas& canvas, const Layout& layout, const ViewState& view,
                    const HudScene& scene, bool in_front) {
  if (!scene.shown.volume || layout.view.empty())
    return;
  const float u = layout.unit;
  const Canvas::Clip clip{canvas, layout.view};
  const Pen pen{canvas, in_front};
  if (view.box_visible) {
    draw_wire_frame(canvas, layout.view, scene, u, in_front);
    const auto draw_plane = [&](SliceAcross across, int place, int count, Colour colour) {
      const float share =
          (static_cast<float>(place) + 0.5F) / static_cast<float>(std::max(count, 1));
      pen.draw(project_slice(scene.camera, scene.extents_mm, across, share, layout.view),
               colour.faded(190), thin_line(u));
    };
    const pipeline::VolumeGeometry& volume = scene.shown.geometry;
    if (layout.crossed.shown() || !layout.legend.empty() || // which takes its place
        view.cut == CutShape::corner)
      draw_plane(SliceAcross::fast, view.a_scan, volume.a_scans, palette::crossed);
    draw_plane(SliceAcross::slow, view.b_scan, volume.b_scans, palette::accent);
  }
  draw_state_marks(pen, layout.view, scene, u);
}

} // namespace octascope::ui
