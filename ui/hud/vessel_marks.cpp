#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>

#include "ui/hud/hud.h"
#include "ui/view/segment_counts.h"
#include "ui/view/vessel_look.h"

namespace octascope::ui {

namespace {

constexpr float row_height = 26; // at unit 1
constexpr float swatch = 16;

Colour to_colour(const VesselColour& colour) {
  const auto bits = [](float v) { return static_cast<std::uint8_t>(v * 255 + 0.5F); };
  return {bits(colour[0]), bits(colour[1]), bits(colour[2])};
}

// What stands there, row by row.
struct MarkRow {
  FixedText<40> words;
  Colour colour{};
  bool swatch = false;
};
struct MarkRows {
  std::array<MarkRow, 10> rows;
  std::size_t count = 0;
  MarkRow& add() { return rows[count++]; }
};

void add_colour(MarkRows& rows, const VesselColour& colour, std::string_view words) {
  MarkRow& row = rows.add();
  row.words.format("{}", words);
  row.colour = to_colour(colour);
  row.swatch = true;
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

// Numbers that add up, whole.
void add_account(MarkRows& rows, const SegmentCounts& account) {
  rows.add().words.format("{} drawn by GL", account.drawn);
  rows.add().words.format("+ {} by the processor", account.splatted);
  rows.add().words.format("+ {} merged", account.merged);
  rows.add().words.format("+ {} outside", account.culled);
  rows.add().words.format("= {} segments", account.total());
}

} // namespace

void draw_vessel_marks(Canvas& canvas, const Layout& layout, const VesselMarks& marks) {
  if (!marks.shown)
    return;
  if (!layout.view_frame.empty()) {
    if (!marks.registered)
      canvas.shadowed_text({static_cast<float>(layout.view.x) + 8 * layout.unit,
                            static_cast<float>(layout.view.y) + 6 * layout.unit},
                           TextStyle::label, palette::warning, "Vessels not registered");
    return;
  }
  MarkRows rows;
  add_colours(rows, marks);
  if (!marks.registration.view().empty())
    rows.add().words = marks.registration;
  if (marks.account)
    add_account(rows, *marks.account);
  if (rows.count == 0)
    return;
  const float u = layout.unit;
  const float text_left = (swatch + 8) * u;
  float width = 0;
  for (std::size_t i = 0; i < rows.count; ++i)
    width = std::max(width, canvas.text_width(TextStyle::label, rows.rows[i].words.view()) +
                                (rows.rows[i].swatch ? text_left : 0));
  const float padding = 10 * u;
  const float height = static_cast<float>(rows.count) * row_height * u + padding;
  const float left = static_cast<float>(layout.view.x) + 16 * u;
  const float top = static_cast<float>(layout.view.bottom()) - 70 * u - height;
  canvas.plate({static_cast<int>(left), static_cast<int>(top),
                static_cast<int>(width + 2 * padding), static_cast<int>(height)},
               palette::plate, 4 * u);
  float middle = top + padding / 2 + row_height * u / 2;
  for (std::size_t i = 0; i < rows.count; ++i) {
    const MarkRow& row = rows.rows[i];
    const float x = left + padding;
    if (row.swatch)
      canvas.dot({x + swatch * u / 2, middle}, swatch * u / 2, row.colour);
    canvas.text(
        {x + (row.swatch ? text_left : 0), middle - canvas.text_height(TextStyle::label) / 2},
        TextStyle::label, palette::text, row.words.view());
    middle += row_height * u;
  }
}

} // namespace octascope::ui
