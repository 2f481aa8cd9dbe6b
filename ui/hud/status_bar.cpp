#include <algorithm>
#include <array>
#include <tuple>

#include "ui/hud/hud.h"

namespace octascope::ui {

namespace {

constexpr float sign_width = 20; // before a device's name, at unit 1
constexpr std::size_t text_cell_count = std::tuple_size_v<decltype(HudText::cells)>;

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
struct DeviceColumns {
  float left;
  float width; // of one
};

DeviceColumns device_columns(const Canvas& canvas, const Layout& layout, const HudText& text) {
  float width = 0;
  for (std::size_t i = 0; i < text.device_count; ++i)
    width =
        std::max(width, canvas.text_width(TextStyle::label, facts_of(text.devices[i].device).name));
  width += (sign_width + 16) * layout.unit;
  const auto columns = static_cast<float>((text.device_count + 1) / 2);
  return {static_cast<float>(layout.status_bar.right()) - columns * width - 4 * layout.unit, width};
}

void draw_devices(Canvas& canvas, const Layout& layout, const HudText& text,
                  const DeviceColumns& columns) {
  const float u = layout.unit;
  const float row_height = 32 * u;
  const float top = static_cast<float>(layout.status_bar.y) + 6 * u;
  for (std::size_t i = 0; i < text.device_count; ++i) {
    const DeviceStatus& device = text.devices[i];
    const float x = columns.left + static_cast<float>(i / 2) * columns.width;
    const float middle = top + (static_cast<float>(i % 2) + 0.5F) * row_height;
    draw_device_sign(canvas, device.state, {x + 6 * u, middle}, 6 * u);
    canvas.text({x + sign_width * u, middle - canvas.text_height(TextStyle::label) / 2},
                TextStyle::label, device_colour(device.state), facts_of(device.device).name);
  }
}

float cell_width(const Canvas& canvas, const StatusCell& cell) {
  return std::max(canvas.text_width(TextStyle::label, cell.label),
                  canvas.text_width(TextStyle::value, cell.value.view()));
}

} // namespace

void draw_status_bar(Canvas& canvas, const Layout& layout, const HudText& text) {
  const float u = layout.unit;
  const float gap = 24 * u;
  const auto top = static_cast<float>(layout.status_bar.y);
  const DeviceColumns columns = device_columns(canvas, layout, text);
  float x = static_cast<float>(layout.status_bar.x) + 16 * u;

  float needed = x;
  for (const StatusCell& cell : text.cells)
    if (!cell.label.empty())
      needed += cell_width(canvas, cell) + gap;
  std::array<bool, text_cell_count> shown;
  for (std::size_t i = 0; i < shown.size(); ++i)
    shown[i] = !text.cells[i].label.empty();
  for (const std::size_t dispensable : HudText::dispensable_cells)
    if (shown[dispensable] && needed > columns.left) {
      shown[dispensable] = false;
      needed -= cell_width(canvas, text.cells[dispensable]) + gap;
    }
  for (std::size_t i = 0; i < text.cells.size(); ++i) {
    if (!shown[i])
      continue;
    const StatusCell& cell = text.cells[i];
    canvas.text({x, top + 8 * u}, TextStyle::label, palette::quiet_text, cell.label);
    canvas.text({x, top + 36 * u}, TextStyle::value, colour_of(cell.tone), cell.value.view());
    x += cell_width(canvas, cell) + gap;
  }
  draw_devices(canvas, layout, text, columns);
}

} // namespace octascope::ui
