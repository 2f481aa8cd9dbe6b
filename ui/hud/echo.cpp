#include "ui/hud/echo.h"

#include <algorithm>

namespace octascope::ui {

namespace {

constexpr std::string_view chosen_words = "The knob turns";

} // namespace

ParameterEcho compose_echo(const ViewState& view, hal::TimePoint now, const Geometry& volume) {
  ParameterEcho echo;
  echo.visible = now < view.echo.until;
  if (!echo.visible)
    return echo;
  const Action action = view.echo.action;
  echo.chosen = view.echo.chosen;
  echo.name = label_of(action);
  echo.value = view.echo.words;
  if (const Number* number = number_of(action)) {
    const NumberRange range = range_of(action, volume);
    const float value = number->of(view);
    if (echo.value.empty())
      echo.value = number->words(value);
    echo.ranged = true;
    echo.share = std::clamp((value - range.lowest) / (range.highest - range.lowest), 0.0F, 1.0F);
  }
  return echo;
}

void draw_echo(Canvas& canvas, const Layout& layout, const ParameterEcho& echo) {
  if (!echo.visible)
    return;
  const float u = layout.unit;
  const float margin = 16 * u;
  const float value_width = canvas.text_width(TextStyle::value, echo.value.view());
  const float words = canvas.text_width(TextStyle::value, echo.name) + 24 * u + value_width;
  const float width = std::max(320 * u, words + 2 * margin);
  const float line = canvas.text_height(TextStyle::value);
  const auto room = static_cast<float>(layout.echo.height);
  const float words_height = line + 24 * u;
  const float heading_height = canvas.text_height(TextStyle::body) + 4 * u; // above the words
  const float bar_height = 14 * u;
  // Where the place is low, the bar goes first.
  const bool heading = echo.chosen && words_height + heading_height <= room;
  const bool bar =
      echo.ranged && words_height + (heading ? heading_height : 0) + bar_height <= room;
  const float height = words_height + (heading ? heading_height : 0) + (bar ? bar_height : 0);
  const float x =
      static_cast<float>(layout.echo.x) + (static_cast<float>(layout.echo.width) - width) / 2;
  const float y = static_cast<float>(layout.echo.bottom()) - height;
  canvas.plate(
      {static_cast<int>(x), static_cast<int>(y), static_cast<int>(width), static_cast<int>(height)},
      palette::plate, 6 * u);
  if (heading)
    canvas.text({x + margin, y + 8 * u}, TextStyle::body, palette::quiet_text, chosen_words);
  const float text_y = y + 10 * u + (heading ? heading_height : 0);
  canvas.text({x + margin, text_y}, TextStyle::value, palette::text, echo.name);
  canvas.text({x + width - margin - value_width, text_y}, TextStyle::value, palette::accent,
              echo.value.view());
  if (!bar)
    return;
  const float bar_y = y + height - 14 * u;
  const float bar_width = width - 2 * margin;
  canvas.line({x + margin, bar_y}, {x + margin + bar_width, bar_y}, palette::hairline, 4 * u);
  canvas.line({x + margin, bar_y}, {x + margin + bar_width * echo.share, bar_y}, palette::accent,
              4 * u);
}

} // namespace octascope::ui
