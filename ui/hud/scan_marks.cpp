#include <algorithm>

#include "ui/hud/hud.h"

namespace octascope::ui {

namespace {

// Shares of the axis that each of the crossed B-scans cuts.
struct Positions {
  float b = 0; // of the B-scan, along the slow axis
  float a = 0; // of the crossed one, along the fast axis
};

Positions positions_of(const ViewState& view, const pipeline::VolumeGeometry& volume) {
  const auto middle = [](int index, int count) {
    return (static_cast<float>(index) + 0.5F) / static_cast<float>(std::max(count, 1));
  };
  return {middle(view.b_scan, volume.b_scans), middle(view.a_scan, volume.a_scans)};
}

// One side of a picture to the other, across at a share of its height, or down at one of its width.
struct Crossing {
  glm::vec2 from;
  glm::vec2 to;
  glm::vec2 along; // a unit long
};

Crossing across(const Rect& rect, float place) {
  const float y =
      static_cast<float>(rect.y) + static_cast<float>(rect.height) * std::clamp(place, 0.0F, 1.0F);
  return {{static_cast<float>(rect.x), y}, {static_cast<float>(rect.right()), y}, {1, 0}};
}

Crossing down(const Rect& rect, float place) {
  const float x =
      static_cast<float>(rect.x) + static_cast<float>(rect.width) * std::clamp(place, 0.0F, 1.0F);
  return {{x, static_cast<float>(rect.y)}, {x, static_cast<float>(rect.bottom())}, {0, 1}};
}

// Short and bright at both ends, where they hide nothing.
void draw_ends(Canvas& canvas, const Crossing& line, Colour colour, float unit) {
  for (const glm::vec2 end : {line.from, line.to})
    canvas.line(end - 6 * unit * line.along, end + 6 * unit * line.along, colour, 3 * unit);
}

void draw_line(Canvas& canvas, const Crossing& line, Colour colour, float unit) {
  canvas.line(line.from, line.to, colour.faded(150), std::max(1.0F, 1.2F * unit));
  draw_ends(canvas, line, colour, unit);
}

// A picture's own colour is above it, and where the other one cuts it, at its borders.
void draw_cut(Canvas& canvas, const Rect& picture, Colour own, float place, Colour other,
              float unit) {
  const float y = static_cast<float>(picture.y) - 2 * unit;
  canvas.line({static_cast<float>(picture.x), y}, {static_cast<float>(picture.right()), y}, own,
              3 * unit);
  draw_ends(canvas, down(picture, place), other, unit);
}

glm::vec2 to_pixels(const Rect& rect, const ScanField::Corner& corner) {
  return {static_cast<float>(rect.x) + corner.x * static_cast<float>(rect.width),
          static_cast<float>(rect.y) + corner.y * static_cast<float>(rect.height)};
}

} // namespace

void draw_scan_marks(Canvas& canvas, const Layout& layout, const ViewState& view,
                     const HudScene& scene) {
  const float u = layout.unit;
  const auto [b, a] = positions_of(view, scene.shown.geometry);
  const float b_place = scene.crop.b.place_of(b);
  const float a_place = scene.crop.a.place_of(a);
  if (layout.en_face.shown()) {
    draw_line(canvas, down(layout.en_face.picture, a_place), palette::crossed, u);
    draw_line(canvas, across(layout.en_face.picture, b_place), palette::accent, u);
  }
  if (layout.b_scan.shown())
    draw_cut(canvas, layout.b_scan.picture, palette::accent, a_place, palette::crossed, u);
  if (layout.crossed.shown())
    draw_cut(canvas, layout.crossed.picture, palette::crossed, b_place, palette::accent, u);
}

void draw_scan_field(Canvas& canvas, const Rect& rect, const ScanField& field,
                     const ViewState& view, const ShownPictures& shown, float unit) {
  const Canvas::Clip clip{canvas, rect};
  std::array<glm::vec2, 4> corners;
  std::ranges::transform(field.corners, corners.begin(),
                         [&](const ScanField::Corner& corner) { return to_pixels(rect, corner); });
  for (std::size_t i = 0; i < corners.size(); ++i)
    canvas.line(corners[i], corners[(i + 1) % corners.size()], palette::accent, 2 * unit);
  canvas.dot(corners[0], 4 * unit, palette::accent);
  if (!shown.volume)
    return;
  const auto draw = [&](glm::vec2 begin, glm::vec2 end, Colour colour) {
    canvas.line(begin, end, colour.faded(170), std::max(1.0F, 1.5F * unit));
    for (const glm::vec2 at : {begin, end})
      canvas.dot(at, 3 * unit, colour);
  };
  const auto between = [&](std::size_t from, std::size_t to, float share) {
    return corners[from] + share * (corners[to] - corners[from]);
  };
  const auto [b, a] = positions_of(view, shown.geometry);
  draw(between(0, 1, a), between(3, 2, a), palette::crossed);
  draw(between(0, 3, b), between(1, 2, b), palette::accent);
}

} // namespace octascope::ui
