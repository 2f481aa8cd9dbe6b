#include <algorithm>

#include "ui/hud/hud.h"

namespace octascope::ui {

namespace {

Colour colour_of(Tone tone) {
  switch (tone) {
  case Tone::normal: return palette::text;
  case Tone::quiet: return palette::quiet_text;
  case Tone::warning: return palette::warning;
  }
  return palette::text;
}

// A filled dot works, a ring does not: told apart without their colours.
void draw_device_sign(Canvas& canvas, hal::DeviceState state, glm::vec2 centre, float radius) {
  switch (state) {
  case hal::DeviceState::streaming:
  case hal::DeviceState::ready: canvas.dot(centre, radius, palette::good); break;
  case hal::DeviceState::absent:
    canvas.ring(centre, radius * 0.85F, palette::warning, radius * 0.45F);
    break;
  case hal::DeviceState::failed:
    canvas.line({centre.x - radius, centre.y - radius}, {centre.x + radius, centre.y + radius},
                palette::alarm, radius * 0.6F);
    canvas.line({centre.x - radius, centre.y + radius}, {centre.x + radius, centre.y - radius},
                palette::alarm, radius * 0.6F);
    break;
  }
}

Colour device_colour(hal::DeviceState state) {
  if (state == hal::DeviceState::failed)
    return palette::alarm;
  return state == hal::DeviceState::absent ? palette::warning : palette::quiet_text;
}

// Two rows, in as many columns as it takes, at the right end of the bar.
void draw_devices(Canvas& canvas, const Layout& layout, const HudText& text) {
  if (text.device_count == 0)
    return;
  const float u = layout.unit;
  const float sign = 18 * u;
  float column = 0;
  for (std::size_t i = 0; i < text.device_count; ++i)
    column = std::max(column, canvas.text_width(TextStyle::label, text.devices[i].name));
  column += sign + 18 * u;
  const std::size_t columns = (text.device_count + 1) / 2;
  const float left =
      static_cast<float>(layout.status_bar.right()) - static_cast<float>(columns) * column - 4 * u;
  const float row_height = 24 * u;
  const float top = static_cast<float>(layout.status_bar.y) + 9 * u;
  for (std::size_t i = 0; i < text.device_count; ++i) {
    const DeviceStatus& device = text.devices[i];
    const float x = left + static_cast<float>(i / 2) * column;
    const float y = top + static_cast<float>(i % 2) * row_height;
    const float middle = y + row_height / 2;
    draw_device_sign(canvas, device.state, {x + 5 * u, middle}, 5 * u);
    canvas.text({x + sign, middle - canvas.text_height(TextStyle::label) / 2}, TextStyle::label,
                device_colour(device.state), device.name);
  }
}

} // namespace

void draw_status_bar(Canvas& canvas, const Layout& layout, const HudText& text) {
  const float u = layout.unit;
  const auto top = static_cast<float>(layout.status_bar.y);
  float x = static_cast<float>(layout.status_bar.x) + 16 * u;
  for (const StatusCell& cell : text.cells) {
    const float label =
        canvas.text({x, top + 9 * u}, TextStyle::label, palette::quiet_text, cell.label);
    const float value =
        canvas.text({x, top + 30 * u}, TextStyle::value, colour_of(cell.tone), cell.value.view());
    x += std::max(label, value) + 26 * u;
  }
  draw_devices(canvas, layout, text);
}

} // namespace octascope::ui
