#include "ui/hud/legend.h"

#include <algorithm>

#include "ui/view/fixed_text.h"

namespace octascope::ui {

namespace {

struct Measures {
  float control = 0; // widths of the columns
  float action = 0;
  float row = 0;
  std::size_t rows = 0; // that there is room for
};

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

Measures measure(const Canvas& canvas, const Legend& legend, TextStyle style, Action selected,
                 float room, float unit) {
  Measures m;
  m.row = canvas.text_height(style) + 5 * unit;
  m.rows = static_cast<std::size_t>(std::max(0.0F, room / m.row));
  for (const LegendLine& line : legend.lines) {
    m.control = std::max(m.control, canvas.text_width(style, line.control));
    m.action = std::max(m.action, canvas.text_width(style, words_of(line, selected).view()));
  }
  return m;
}

// Beside the large picture it may reach over that, but not near its middle.
float widest(const Layout& layout) {
  const auto place = static_cast<float>(layout.legend.width);
  if (layout.legend.x < layout.large.right())
    return place;
  const float middle =
      static_cast<float>(layout.large.x) + static_cast<float>(layout.large.width) * 0.75F;
  return std::max(place, static_cast<float>(layout.legend.right()) - middle);
}

} // namespace

void draw_legend(Canvas& canvas, const Layout& layout, const Legend& legend, Action selected) {
  const float u = layout.unit;
  const float margin = 18 * u;
  const float gap = 22 * u; // between the columns
  const auto right = static_cast<float>(layout.legend.right());
  const auto top = static_cast<float>(layout.legend.y);
  const auto most_height = static_cast<float>(layout.legend.height);
  const float title = canvas.text_height(TextStyle::badge) + 16 * u;
  const float room = most_height - title - 2 * margin;
  const float most_width = widest(layout);

  TextStyle style = TextStyle::value;
  Measures m = measure(canvas, legend, style, selected, room, u);
  const auto width_of = [&](const Measures& each) {
    return each.control + gap + each.action + 2 * margin;
  };
  if (m.rows < legend.lines.size() || width_of(m) > most_width) {
    style = TextStyle::body;
    m = measure(canvas, legend, style, selected, room, u);
  }
  const bool cut = legend.lines.size() > m.rows;
  const std::size_t shown = cut ? std::max<std::size_t>(m.rows, 1) - 1 : legend.lines.size();
  const float title_width = canvas.text_width(TextStyle::badge, legend.title) + 2 * margin;
  FixedText<64> more;
  more.format("{} more do not fit here", legend.lines.size() - shown);
  const float more_width = cut ? canvas.text_width(style, more.view()) + 2 * margin : 0;
  const float width = std::max({width_of(m), title_width, more_width});
  const float height =
      title + 2 * margin + m.row * static_cast<float>(cut ? shown + 1 : shown) - 5 * u;
  const Rect plate{static_cast<int>(right - width), static_cast<int>(top), static_cast<int>(width),
                   static_cast<int>(height)};
  canvas.plate(plate, palette::panel, 6 * u);
  canvas.frame(plate, palette::hairline, std::max(1.0F, u), 6 * u);

  const float left = right - width + margin;
  float y = top + margin;
  canvas.text({left, y}, TextStyle::badge, palette::text, legend.title);
  y += title;
  canvas.line({left, y - 8 * u}, {right - margin, y - 8 * u}, palette::hairline, std::max(1.0F, u));
  for (std::size_t i = 0; i < shown; ++i) {
    const LegendLine& line = legend.lines[i];
    canvas.text({left, y}, style, palette::quiet_text, line.control);
    canvas.text({left + m.control + gap, y}, style,
                line.action == Action::adjust ? palette::accent : palette::text,
                words_of(line, selected).view());
    y += m.row;
  }
  if (cut)
    canvas.text({left, y}, style, palette::warning, more.view());
}

} // namespace octascope::ui
