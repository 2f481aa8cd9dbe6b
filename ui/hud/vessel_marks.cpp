#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include "ui/hud/hud.h"
#include "ui/transfer/flow_look.h"
#include "ui/view/segment_counts.h"
#include "ui/view/vessel_look.h"

namespace octascope::ui {

namespace {

constexpr float row_height = 29; // at unit 1
constexpr float swatch = 16;
constexpr float flow_swatch = 40;

Colour to_colour(const VesselColour& colour) {
  const auto bits = [](float v) { return static_cast<std::uint8_t>(v * 255 + 0.5F); };
  return {bits(colour[0]), bits(colour[1]), bits(colour[2])};
}

// What stands there, row by row.
struct MarkRow {
  FixedText<96> words;
  bool warning = false;
  Colour colour{};
  float swatch = 0; // its width, at unit 1; 0: none
};
struct MarkRows {
  std::array<MarkRow, 12> rows;
  std::size_t count = 0;
  MarkRow& add() { return rows[count++]; }
};

void add_colour(MarkRows& rows, const VesselColour& colour, std::string_view words) {
  MarkRow& row = rows.add();
  row.words.format("{}", words);
  row.colour = to_colour(colour);
  row.swatch = swatch;
}

void add_colours(MarkRows& rows, const VesselMarks& marks) {
  constexpr std::array<std::string_view, pipeline::vessel_branch_count> names{"other vessels",
                                                                              "RCA", "LAD", "LCX"};
  switch (marks.colouring) {
  case VesselColouring::branch:
    for (std::size_t i = 0; i < names.size(); ++i)
      if (marks.branches[i])
        add_colour(rows, branch_colours[i], names[i]);
    return;
  case VesselColouring::order:
    add_colour(rows, order_colours.front(), "order 0: capillary");
    add_colour(rows, order_colours[order_colours.size() / 2], "order 6");
    add_colour(rows, order_colours.back(), "order 11: main artery");
    return;
  case VesselColouring::diagnostic:
    add_colour(rows, drawn_by_gl, "drawn by GL");
    add_colour(rows, drawn_by_processor, "drawn by the processor");
    return;
  }
}

void add_flow(MarkRows& rows) {
  MarkRow& row = rows.add();
  row.words.format("static to flowing");
  row.swatch = flow_swatch;
}

// From a tissue's grey on.
void draw_flow_colours(Canvas& canvas, glm::vec2 left_middle, float unit) {
  constexpr int pieces = 20;
  const float piece = flow_swatch * unit / pieces;
  for (int i = 0; i < pieces; ++i) {
    const float share = (static_cast<float>(i) + 0.5F) / pieces;
    const TransferTable::Colour colour = with_flow({0.45F, 0.45F, 0.45F}, share);
    const float x = left_middle.x + static_cast<float>(i) * piece;
    canvas.bar({x, left_middle.y - swatch / 2 * unit},
               {x + piece, left_middle.y + swatch / 2 * unit},
               to_colour({colour.red, colour.green, colour.blue}));
  }
}

// Numbers that add up, whole.
void add_account(MarkRows& rows, const SegmentCounts& account) {
  rows.add().words.format("{} drawn by GL", account.drawn);
  rows.add().words.format("+ {} by the processor", account.splatted);
  rows.add().words.format("+ {} merged", account.merged);
  rows.add().words.format("+ {} outside", account.culled);
  rows.add().words.format("= {} segments", account.total());
}

// In a small volume, where there is no badge.
void draw_unregistered(Canvas& canvas, const Layout& layout) {
  const float u = layout.unit;
  constexpr std::string_view words = "Vessels not registered";
  const bool fits =
      canvas.text_width(TextStyle::label, words) + 8 * u < static_cast<float>(layout.view.width);
  canvas.shadowed_text(
      {static_cast<float>(layout.view.x) + 4 * u, static_cast<float>(layout.view.y) + 4 * u},
      TextStyle::label, palette::warning, fits ? words : "Unregistered");
}

} // namespace

void draw_vessel_marks(Canvas& canvas, const Layout& layout, const VesselMarks& marks) {
  const bool traced = !marks.tree.view().empty();
  if ((!marks.shown && !marks.flow && !traced) || layout.view.empty())
    return;
  if (!layout.view_frame.empty()) {
    if (marks.shown && !marks.registered)
      draw_unregistered(canvas, layout);
    return;
  }
  MarkRows rows;
  if (marks.flow)
    add_flow(rows);
  if (marks.shown)
    add_colours(rows, marks);
  if (!marks.registration.view().empty())
    rows.add().words.format("{}", marks.registration.view());
  if (traced) {
    MarkRow& row = rows.add();
    row.words.format("{}", marks.tree.view());
    row.warning = marks.tree_old;
  }
  if (marks.account)
    add_account(rows, *marks.account);
  if (rows.count == 0)
    return;
  const float u = layout.unit;
  const auto text_left = [u](const MarkRow& row) {
    return row.swatch > 0 ? (row.swatch + 8) * u : 0;
  };
  const float padding = 8 * u;
  const float scale = 44 * u; // under all of it
  // Column by column in the view's lower quarter.
  const float room = static_cast<float>(layout.view.height) / 4 - scale - 2 * padding;
  const auto a_column = static_cast<std::size_t>(std::max(1.0F, room / (row_height * u)));
  const float height =
      static_cast<float>(std::min(a_column, rows.count)) * row_height * u + 2 * padding;
  const float top = static_cast<float>(layout.view.bottom()) - scale - height;
  float left = static_cast<float>(layout.view.x) + 14 * u;
  const Canvas::Clip clip{canvas, layout.view};
  for (std::size_t begin = 0; begin < rows.count; begin += a_column) {
    const std::size_t end = std::min(begin + a_column, rows.count);
    float width = 0;
    for (std::size_t i = begin; i < end; ++i)
      width = std::max(width, canvas.text_width(TextStyle::label, rows.rows[i].words.view()) +
                                  text_left(rows.rows[i]));
    const Rect plate{static_cast<int>(left), static_cast<int>(top),
                     static_cast<int>(width + 2 * padding), static_cast<int>(height)};
    canvas.plate(plate, palette::plate, 4 * u);
    float middle = top + padding + row_height * u / 2;
    for (std::size_t i = begin; i < end; ++i) {
      const MarkRow& row = rows.rows[i];
      const float x = left + padding;
      if (row.swatch > swatch)
        draw_flow_colours(canvas, {x, middle}, u);
      else if (row.swatch > 0)
        canvas.dot({x + swatch * u / 2, middle}, swatch * u / 2, row.colour);
      canvas.text({x + text_left(row), middle - canvas.text_height(TextStyle::label) / 2},
                  TextStyle::label, row.warning ? palette::warning : palette::text,
                  row.words.view());
      middle += row_height * u;
    }
    left += static_cast<float>(plate.width) + 4 * u;
  }
}

} // namespace octascope::ui
