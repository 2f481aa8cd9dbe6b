#include "ui/hud/legend.h"

#include <algorithm>

#include "ui/view/fixed_text.h"

namespace octascope::ui {

namespace {

FixedText<64> words_of(const LegendLine& line, Action selected) {
  FixedText<64> words;
  if (line.action == Action::adjust)
    words.format("{}: {}", label_of(line.action), label_of(selected));
  else
    words.format("{}{}", label_of(line.action),
                 kind_of(line.action) == ActionKind::toggle ? " on, off" : "");
  if (line.back) {
    FixedText<64> back;
    back.format("{}, back", words.view());
    return back;
  }
  return words;
}

// Counts rows, and draws those of one page.
class Rows {
public:
  Rows(Canvas& canvas, glm::vec2 top_left, float pitch)
      : canvas_{canvas}, top_left_{top_left}, pitch_{pitch} {}

  void show(std::int64_t first, std::int64_t count) {
    first_ = first;
    last_ = first + count;
    count_ = 0;
  }
  std::int64_t count() const { return count_; }
  void next() { ++count_; }
  void put(float x, Colour colour, std::string_view words) {
    if (count_ >= first_ && count_ < last_)
      canvas_.text({top_left_.x + x, top_left_.y + static_cast<float>(count_ - first_) * pitch_},
                   TextStyle::label, colour, words);
  }

private:
  Canvas& canvas_;
  glm::vec2 top_left_;
  float pitch_;
  std::int64_t first_ = 0;
  std::int64_t last_ = 0;
  std::int64_t count_ = 0;
};

struct Columns {
  float actions = 0; // where they begin
  bool beside = true;
};

Columns measure(const Canvas& canvas, const Legend& legend, Action selected, float gap,
                float width) {
  float control = 0;
  float action = 0;
  for (const LegendLine& line : legend.lines) {
    control = std::max(control, canvas.text_width(TextStyle::label, line.control));
    action = std::max(action, canvas.text_width(TextStyle::label, words_of(line, selected).view()));
  }
  const bool beside = control + gap + action <= width;
  return {beside ? control + gap : gap, beside};
}

void lay_out_lines(Rows& rows, const Legend& legend, Action selected, const Columns& columns) {
  for (const LegendLine& line : legend.lines) {
    rows.put(0, palette::quiet_text, line.control);
    if (!columns.beside)
      rows.next();
    rows.put(columns.actions, line.action == Action::adjust ? palette::accent : palette::text,
             words_of(line, selected).view());
    rows.next();
  }
}

// One after the other, as many in a row as fit.
void lay_out_menu(Rows& rows, const Canvas& canvas, const Legend& legend, Action selected,
                  float gap, float width) {
  if (legend.menu.empty())
    return;
  rows.put(0, palette::quiet_text, "The knob turns one of");
  rows.next();
  float x = gap;
  for (const Action action : legend.menu) {
    const std::string_view words = label_of(action);
    const float length = canvas.text_width(TextStyle::label, words);
    if (x > gap && x + length > width) {
      rows.next();
      x = gap;
    }
    rows.put(x, action == selected ? palette::accent : palette::text, words);
    x += length + gap;
  }
  rows.next();
}

} // namespace

void draw_legend(Canvas& canvas, const Layout& layout, const Legend& legend, Action selected,
                 std::int64_t page) {
  if (layout.legend.empty())
    return;
  const float u = layout.unit;
  const float margin = 16 * u;
  const float gap = 22 * u; // between the columns
  const Rect& plate = layout.legend;
  const Canvas::Clip clip{canvas, plate};
  canvas.plate(plate, palette::panel, 6 * u);
  canvas.frame(plate, palette::hairline, std::max(1.0F, u), 6 * u);

  const float left = static_cast<float>(plate.x) + margin;
  const float width = static_cast<float>(plate.width) - 2 * margin;
  const float title = canvas.text_height(TextStyle::value) + 14 * u;
  const float top = static_cast<float>(plate.y) + 10 * u;
  const float pitch = canvas.text_height(TextStyle::label) + 4 * u;
  const Columns columns = measure(canvas, legend, selected, gap, width);
  const float room = static_cast<float>(plate.bottom()) - top - title - 8 * u;
  auto a_page = std::max(std::int64_t{1}, static_cast<std::int64_t>(room / pitch));
  if (!columns.beside) // nothing is torn apart
    a_page = std::max(std::int64_t{2}, a_page / 2 * 2);

  Rows rows{canvas, {left, top + title}, pitch};
  const auto lay_out_all = [&] {
    lay_out_lines(rows, legend, selected, columns);
    lay_out_menu(rows, canvas, legend, selected, gap, width);
  };
  lay_out_all(); // none is drawn yet
  const std::int64_t pages = std::max(std::int64_t{1}, (rows.count() + a_page - 1) / a_page);
  const std::int64_t shown = page % pages;
  rows.show(shown * a_page, a_page);
  lay_out_all();

  FixedText<24> number;
  if (pages > 1)
    number.format("{} of {}", shown + 1, pages);
  const float number_width = canvas.text_width(TextStyle::label, number.view());
  canvas.text({left + width - number_width, top + 2 * u}, TextStyle::label, palette::warning,
              number.view());
  const float line = top + title - 8 * u;
  canvas.line({left, line}, {left + width, line}, palette::hairline, std::max(1.0F, u));
  const Canvas::Clip title_clip{
      canvas,
      {plate.x, plate.y, static_cast<int>(width - number_width), static_cast<int>(title + 10 * u)}};
  canvas.text({left, top}, TextStyle::value, palette::text, legend.title);
}

} // namespace octascope::ui
