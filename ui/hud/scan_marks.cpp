#include <algorithm>
#include <cmath>

#include "ui/hud/calliper.h"
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

// Along the right border: a tick a round length, the depth from zero delay beside it, and four short
// ticks between.
bool overlap(const Rect& a, const Rect& b) {
  return a.x < b.right() && b.x < a.right() && a.y < b.bottom() && b.y < a.bottom();
}

// Numbers stay out of the picture's middle half and off `covered`.
void draw_ruler(Canvas& canvas, const Rect& picture, const Section& shown, double depth_mm,
                const Rect& covered, float unit) {
  const double mm_per_pixel = depth_mm * static_cast<double>(shown.length()) / picture.height;
  const float letters = canvas.text_height(TextStyle::label);
  const double step_mm = round_ruler_step_mm(mm_per_pixel * 1.6 * static_cast<double>(letters));
  const bool in_mm = step_mm >= 0.1;
  const auto right = static_cast<float>(picture.right());
  const double first_mm = depth_mm * static_cast<double>(shown.from);
  const double last_mm = depth_mm * static_cast<double>(shown.to);
  const auto tick = [&](float y, float length, float width, Colour colour) {
    canvas.line({right - length, y}, {right, y}, palette::ink.faded(160), width + 2 * unit);
    canvas.line({right - length, y}, {right, y}, colour, width);
  };
  const auto lowest = static_cast<float>(overlap(picture, covered) ? covered.y : picture.bottom());
  bool said = false; // the unit: once, at the first
  constexpr int parts = 5;
  const double part_mm = step_mm / parts;
  for (auto i = static_cast<int>(std::ceil(first_mm / part_mm)); i * part_mm <= last_mm; ++i) {
    const float y =
        static_cast<float>(picture.y) + static_cast<float>((i * part_mm - first_mm) / mm_per_pixel);
    if (i % parts != 0) {
      tick(y, 5 * unit, std::max(1.0F, unit), palette::quiet_text);
      continue;
    }
    tick(y, 11 * unit, std::max(1.0F, 2 * unit), palette::text);
    const float top = y - letters / 2;
    if (top < static_cast<float>(picture.y) || top + letters > static_cast<float>(picture.bottom()))
      continue;
    FixedText<16> words;
    words.format("{:g}{}", i * part_mm * (in_mm ? 1 : 1e3), said ? "" : in_mm ? " mm" : " µm");
    const float left = right - 15 * unit - canvas.text_width(TextStyle::label, words.view());
    const bool fits = left > right - static_cast<float>(picture.width) / 4;
    if ((!fits && !said) || top + letters > lowest)
      continue;
    said = true;
    canvas.shadowed_text({left, top}, TextStyle::label, palette::text, words.view());
  }
}

// Crosses in the voxels, the line between them, and the distance in the upper left corner.
void draw_calliper(Canvas& canvas, const Rect& picture, const ViewState& view,
                   const HudScene& scene, float unit) {
  const pipeline::VolumeGeometry& volume = scene.shown.geometry;
  const auto place = [&](int a, int depth) {
    const float across =
        scene.crop.a.place_of((static_cast<float>(a) + 0.5F) / static_cast<float>(volume.a_scans));
    const float down = scene.crop.depth.place_of((static_cast<float>(depth) + 0.5F) /
                                                 static_cast<float>(volume.depths));
    return glm::vec2{static_cast<float>(picture.x) + across * static_cast<float>(picture.width),
                     static_cast<float>(picture.y) + down * static_cast<float>(picture.height)};
  };
  const std::array marks{place(view.mark_1_a, view.mark_1_depth),
                         place(view.mark_2_a, view.mark_2_depth)};
  const Canvas::Clip clip{canvas, picture};
  const auto draw = [&](Colour colour, float width) {
    canvas.line(marks[0], marks[1], colour.faded(static_cast<std::uint8_t>(colour.a * 2 / 3)),
                width);
    for (const glm::vec2 mark : marks) {
      canvas.line(mark - glm::vec2{9 * unit, 0}, mark + glm::vec2{9 * unit, 0}, colour, width);
      canvas.line(mark - glm::vec2{0, 9 * unit}, mark + glm::vec2{0, 9 * unit}, colour, width);
    }
  };
  const float thin = std::max(1.0F, 1.5F * unit);
  draw(palette::ink.faded(160), thin + 2 * unit);
  draw(palette::calliper, thin);
  for (std::size_t i = 0; i < marks.size(); ++i)
    canvas.shadowed_text(marks[i] + glm::vec2{6 * unit, 2 * unit}, TextStyle::label,
                         palette::calliper, i == 0 ? "1" : "2");
  canvas.shadowed_text(
      {static_cast<float>(picture.x) + 8 * unit, static_cast<float>(picture.y) + 6 * unit},
      TextStyle::label, palette::calliper, words_of(calliper_distance(view, volume)).view());
}

} // namespace

glm::vec2 to_pixels(const Rect& rect, const ScanField::Corner& corner) {
  return {static_cast<float>(rect.x) + corner.x * static_cast<float>(rect.width),
          static_cast<float>(rect.y) + corner.y * static_cast<float>(rect.height)};
}

double round_ruler_step_mm(double least_mm) {
  const double power = std::pow(10.0, std::floor(std::log10(least_mm)));
  for (const double digit : {1.0, 2.0, 5.0})
    if (digit * power >= least_mm)
      return digit * power;
  return 10 * power;
}

void draw_scan_marks(Canvas& canvas, const Layout& layout, const ViewState& view,
                     const HudScene& scene, const Rect& covered) {
  const float u = layout.unit;
  const auto [b, a] = positions_of(view, scene.shown.geometry);
  const float b_place = scene.crop.b.place_of(b);
  const float a_place = scene.crop.a.place_of(a);
  if (layout.en_face.shown()) {
    draw_line(canvas, down(layout.en_face.picture, a_place), palette::crossed, u);
    draw_line(canvas, across(layout.en_face.picture, b_place), palette::accent, u);
  }
  const double depth_mm = scene.shown.geometry.depth_mm();
  if (layout.b_scan.shown()) {
    draw_cut(canvas, layout.b_scan.picture, palette::accent, a_place, palette::crossed, u);
    draw_ruler(canvas, layout.b_scan.picture, scene.crop.depth, depth_mm, covered, u);
    if (view.calliper)
      draw_calliper(canvas, layout.b_scan.picture, view, scene, u);
  }
  if (layout.crossed.shown()) {
    draw_cut(canvas, layout.crossed.picture, palette::crossed, b_place, palette::accent, u);
    draw_ruler(canvas, layout.crossed.picture, scene.crop.depth, depth_mm, covered, u);
  }
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
