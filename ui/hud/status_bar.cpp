#include <algorithm>
#include <array>

#include "ui/hud/hud.h"
#include "ui/hud/two_lines.h"

namespace octascope::ui {

namespace {

// Lengths at unit 1.
constexpr float side = 16; // to the bar's ends
constexpr float gap = 24;  // between what stands side by side
constexpr float sign_width = 22;
constexpr std::size_t trouble_rows = 3;
constexpr std::size_t most_columns = 2;

void draw_trouble_sign(Canvas& canvas, Trouble::Sign sign, glm::vec2 centre, float radius) {
  switch (sign) {
  case Trouble::Sign::absent:
    canvas.ring(centre, radius * 0.85F, palette::warning, radius * 0.45F);
    return;
  case Trouble::Sign::failed:
    for (const float up : {-1.0F, 1.0F})
      canvas.line({centre.x - radius, centre.y - up * radius},
                  {centre.x + radius, centre.y + up * radius}, palette::alarm, radius * 0.6F);
    return;
  case Trouble::Sign::lost:
    canvas.line({centre.x, centre.y - radius}, {centre.x, centre.y + radius * 0.35F},
                palette::warning, radius * 0.45F);
    canvas.dot({centre.x, centre.y + radius * 0.85F}, radius * 0.3F, palette::warning);
    return;
  case Trouble::Sign::loading:
    canvas.ring(centre, radius * 0.85F, palette::quiet_text, radius * 0.3F);
    return;
  }
}

Colour colour_of(Trouble::Sign sign) {
  switch (sign) {
  case Trouble::Sign::failed: return palette::alarm;
  case Trouble::Sign::loading: return palette::quiet_text;
  case Trouble::Sign::absent:
  case Trouble::Sign::lost: return palette::warning;
  }
  return palette::warning;
}

// Column by column at the bar's right end; what finds no place is counted. Returns their left end.
float draw_troubles(Canvas& canvas, const Layout& layout, const HudText& text) {
  const float u = layout.unit;
  const auto right = static_cast<float>(layout.status_bar.right());
  const auto top = static_cast<float>(layout.status_bar.y);
  if (text.trouble_count == 0)
    return right - side * u;
  constexpr std::size_t places = trouble_rows * most_columns;
  const std::size_t shown = text.trouble_count > places ? places - 1 : text.trouble_count;
  FixedText<40> more;
  if (shown < text.trouble_count)
    more.format("{} more", text.trouble_count - shown);
  std::array<std::string_view, places> words{};
  for (std::size_t i = 0; i < shown; ++i)
    words[i] = text.troubles[i].words.view();
  const std::size_t count = shown + (more.empty() ? 0 : 1);
  if (!more.empty())
    words[shown] = more.view();

  const std::size_t columns = (count + trouble_rows - 1) / trouble_rows;
  const float row = static_cast<float>(layout.status_bar.height) / trouble_rows;
  float left = right;
  for (std::size_t column = columns; column-- > 0;) {
    const std::size_t begin = column * trouble_rows;
    const std::size_t end = std::min(begin + trouble_rows, count);
    float width = 0;
    for (std::size_t i = begin; i < end; ++i)
      width = std::max(width, canvas.text_width(TextStyle::label, words[i]));
    left -= width + (sign_width + side) * u;
    for (std::size_t i = begin; i < end; ++i) {
      const float middle = top + (static_cast<float>(i - begin) + 0.5F) * row;
      const Trouble::Sign sign = i < shown ? text.troubles[i].sign : Trouble::Sign::lost;
      draw_trouble_sign(canvas, sign, {left + 7 * u, middle}, 7 * u);
      canvas.text({left + sign_width * u, middle - canvas.text_height(TextStyle::label) / 2},
                  TextStyle::label, colour_of(sign), words[i]);
    }
  }
  return left - gap * u;
}

// From `left` to `right`, on the middle line of a row.
struct Row {
  Canvas& canvas;
  float unit;
  float left;
  float right;
  float middle;

  bool fits(float width) const { return left + width <= right; }
  float top(TextStyle style) const { return middle - canvas.text_height(style) / 2; }
  void put(TextStyle style, Colour colour, std::string_view words) {
    left += canvas.text({left, top(style)}, style, colour, words) + gap * unit;
  }
};

// A notice that is too long for its line is shown in two parts, in turn.
std::string_view page_of(const Canvas& canvas, std::string_view words, float room,
                         std::int64_t page) {
  const auto width = [&](std::string_view part) {
    return canvas.text_width(TextStyle::label, part);
  };
  const TwoLines parts = break_to_fit(words, room, width);
  return parts.second.empty() || page % 2 == 0 ? parts.first : parts.second;
}

void draw_notice(Row& row, const HudText& text, const Rect& place) {
  const float u = row.unit;
  Canvas& canvas = row.canvas;
  canvas.plate({place.x, place.y, static_cast<int>(8 * u), place.height}, palette::warning);
  const std::string_view words = text.notice.view();
  const TextStyle style =
      row.fits(canvas.text_width(TextStyle::value, words)) ? TextStyle::value : TextStyle::label;
  const Canvas::Clip clip{
      canvas, {place.x, place.y, std::max(0, static_cast<int>(row.right) - place.x), place.height}};
  row.put(style, palette::text,
          style == TextStyle::value ? words
                                    : page_of(canvas, words, row.right - row.left, text.page));
}

void draw_facts(Row& row, const HudText& text) {
  const std::size_t count = text.notice.empty() ? text.facts.size() : text.facts.size() - 2;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string_view words = text.facts[i].view();
    if (!words.empty() && row.fits(row.canvas.text_width(TextStyle::label, words)))
      row.put(TextStyle::label, palette::quiet_text, words);
  }
}

void draw_recording(Row& row, std::string_view words) {
  const float u = row.unit;
  const float height = row.canvas.text_height(TextStyle::badge);
  const float width = row.canvas.text_width(TextStyle::badge, words) + 54 * u;
  row.canvas.plate({static_cast<int>(row.left), static_cast<int>(row.middle - height / 2),
                    static_cast<int>(width), static_cast<int>(height)},
                   palette::recording, 5 * u);
  row.canvas.dot({row.left + 24 * u, row.middle}, 11 * u, palette::text);
  row.canvas.text({row.left + 44 * u, row.top(TextStyle::badge)}, TextStyle::badge, palette::text,
                  words);
  row.left += width + gap * u;
}

// What the knob turns; while a control has just done something, what that was.
struct KnobWords {
  std::string_view name;
  std::string_view value;

  float width(const Canvas& canvas, TextStyle style, float unit) const {
    const float apart = value.empty() ? 0 : 16 * unit + canvas.text_width(style, value);
    return canvas.text_width(style, name) + apart;
  }
};

constexpr float knob_width = 46; // of its sign, at unit 1

void draw_knob(Row& row, const HudText& text, const KnobWords& words) {
  const float u = row.unit;
  Canvas& canvas = row.canvas;
  const float radius = 15 * u;
  const glm::vec2 centre{row.left + radius, row.middle};
  if (!text.echo.visible || text.echo.chosen || words.name == label_of(text.selected)) {
    canvas.ring(centre, radius, palette::accent, 4 * u);
    canvas.line(centre, {centre.x + radius * 0.6F, centre.y - radius * 0.6F}, palette::accent,
                4 * u);
  }
  row.left += knob_width * u;
  const float room = row.right - row.left;
  TextStyle style = TextStyle::badge;
  for (const TextStyle smaller : {TextStyle::value, TextStyle::label})
    if (words.width(canvas, style, u) > room)
      style = smaller;
  const Canvas::Clip clip{canvas,
                          {static_cast<int>(row.left), static_cast<int>(row.middle - 40 * u),
                           std::max(0, static_cast<int>(room)), static_cast<int>(80 * u)}};
  const float begin = row.left;
  row.put(style, text.echo.visible ? palette::quiet_text : palette::text, words.name);
  row.left -= (gap - 16) * u;
  if (!words.value.empty() && row.left < row.right)
    row.put(style, palette::accent, words.value);
  if (!text.echo.visible || !text.echo.ranged)
    return;
  const float y = row.middle + 21 * u;
  const float length = std::min(room, 300 * u);
  canvas.line({begin, y}, {begin + length, y}, palette::hairline, 4 * u);
  canvas.line({begin, y}, {begin + length * text.echo.share, y}, palette::accent, 4 * u);
}

} // namespace

void draw_status_bar(Canvas& canvas, const Layout& layout, const HudText& text) {
  const float u = layout.unit;
  const Rect& bar = layout.status_bar;
  const Rect& top = layout.notice;
  const float right = draw_troubles(canvas, layout, text);
  const float left = static_cast<float>(bar.x) + side * u;
  Row row{canvas, u, left, right,
          static_cast<float>(top.y) + static_cast<float>(top.height) / 2 + 1 * u};
  if (!text.notice.empty())
    draw_notice(row, text, top);
  draw_facts(row, text);

  row.left = left;
  row.middle = static_cast<float>(top.bottom() + bar.bottom()) / 2 - 1 * u;
  const KnobWords words = text.echo.visible ? KnobWords{text.echo.name, text.echo.value.view()}
                                            : KnobWords{label_of(text.selected), {}};
  row.put(TextStyle::badge, text.eye.view() == "eye not said" ? palette::quiet_text : palette::text,
          text.eye.view());
  if (!text.recording.empty())
    draw_recording(row, text.recording.view());
  // The time of day gives way to what has no other place.
  const float time = canvas.text_width(TextStyle::badge, text.time_of_day.view()) + gap * u;
  if (row.fits(time + knob_width * u + words.width(canvas, TextStyle::value, u)))
    row.put(TextStyle::badge, palette::text, text.time_of_day.view());
  draw_knob(row, text, words);
}

} // namespace octascope::ui
