#include "ui/layout.h"

#include <algorithm>
#include <cmath>

namespace octascope::ui {

namespace {

int scaled(float unit, float length) {
  return std::max(1, static_cast<int>(std::lround(unit * length)));
}

// The largest rectangle of that aspect within `room`, centred.
Rect fit(const Rect& room, double aspect) {
  const int width = std::min(room.width, static_cast<int>(std::lround(room.height * aspect)));
  const int height = std::min(room.height, static_cast<int>(std::lround(width / aspect)));
  return {room.x + (room.width - width) / 2, room.y + (room.height - height) / 2,
          std::max(1, width), std::max(1, height)};
}

Panel make_panel(const Rect& frame, float unit, double aspect) {
  const int title = scaled(unit, 32);
  const int margin = scaled(unit, 8);
  const Rect room{frame.x + margin, frame.y + title, std::max(1, frame.width - 2 * margin),
                  std::max(1, frame.height - title - margin)};
  return {frame, {frame.x + margin, frame.y, room.width, title}, fit(room, aspect)};
}

} // namespace

Layout lay_out(int width, int height, const PictureAspects& aspects) {
  Layout layout;
  // Narrow pictures scale with their width, so that the status bar still fits.
  layout.unit = std::min(static_cast<float>(height) / 720, static_cast<float>(width) / 1200);
  const int gap = scaled(layout.unit, 8);
  const int bar = scaled(layout.unit, 66);
  const int column = static_cast<int>(std::lround(width * 0.3));
  layout.status_bar = {0, height - bar, width, bar};
  const int body = std::max(3, height - bar);
  layout.view = {0, 0, std::max(1, width - column), body};

  const int x = layout.view.right();
  const int panel_width = std::max(1, column - gap);
  const int panel_height = std::max(1, (body - 3 * gap) / 3);
  int y = gap;
  const auto next = [&](double aspect) {
    const Panel panel = make_panel({x, y, panel_width, panel_height}, layout.unit, aspect);
    y += panel_height + gap;
    return panel;
  };
  layout.b_scan = next(aspects.b_scan);
  layout.en_face = next(aspects.en_face);
  layout.scope = next(aspects.scope);
  return layout;
}

} // namespace octascope::ui
