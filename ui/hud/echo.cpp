#include "ui/hud/echo.h"

#include <algorithm>

namespace octascope::ui {

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

} // namespace octascope::ui
