#include <algorithm>
#include <array>
#include <tuple>

#include "ui/hud/hud.h"

namespace octascope::ui {

namespace {

constexpr float sign_width = 20; // before a device's name, at unit 1
constexpr std::size_t figure_count = std::tuple_size_v<decltype(HudText::figures)>;

Colour colour_of(Tone tone) {
  return tone == Tone::warning ? palette::warning : palette::text;
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
    for (const float up : {-1.0F, 1.0F})
      canvas.line({centre.x - radius, centre.y - up * radius},
                  {centre.x + radius, centre.y + up * radius}, palette::alarm, radius * 0.6F);
    break;
  }
}

// Two rows, in as many columns as it takes, at the strip's right end. Returns their left end.
float draw_devices(Canvas& canvas, const Layout& layout, const HudText& text) {
  const float u = layout.unit;
  float width = 0;
  for (std::size_t i = 0; i < text.device_count; ++i)
    width =
        std::max(width, canvas.text_width(TextStyle::label, facts_of(text.devices[i].device).name));
  width += (sign_width + 14) * u;
  const auto columns = static_cast<float>((text.device_count + 1) / 2);
  const float left = static_cast<float>(layout.figures.right()) - columns * width;
  const float row = static_cast<float>(layout.figures.height) / 2;
  for (std::size_t i = 0; i < text.device_count; ++i) {
    const DeviceStatus& device = text.devices[i];
    const float x = left + static_cast<float>(i / 2) * width;
    const float middle =
        static_cast<float>(layout.figures.y) + (static_cast<float>(i % 2) + 0.5F) * row;
    draw_device_sign(canvas, device.state, {x + 6 * u, middle}, 6 * u);
    canvas.text({x + sign_width * u, middle - canvas.text_height(TextStyle::label) / 2},
                TextStyle::label, palette::quiet_text, facts_of(device.device).name);
  }
  return left;
}

float width_of(const Canvas& canvas, const StatusCell& cell) {
  return std::max(canvas.text_width(TextStyle::label, cell.label),
                  canvas.text_width(TextStyle::value, cell.value.view()));
}

} // namespace

void draw_engineers_strip(Canvas& canvas, const Layout& layout, const HudText& text) {
  if (layout.figures.empty() || !text.figures_shown)
    return;
  const float u = layout.unit;
  const float gap = 20 * u;
  const auto top = static_cast<float>(layout.figures.y);
  const float right = draw_devices(canvas, layout, text);
  float x = static_cast<float>(layout.figures.x) + 16 * u;

  float needed = x;
  std::array<bool, figure_count> shown;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    shown[i] = !text.figures[i].label.empty();
    needed += shown[i] ? width_of(canvas, text.figures[i]) + gap : 0;
  }
  for (const std::size_t dispensable : HudText::dispensable_figures)
    if (shown[dispensable] && needed > right) {
      shown[dispensable] = false;
      needed -= width_of(canvas, text.figures[dispensable]) + gap;
    }
  for (std::size_t i = 0; i < text.figures.size(); ++i) {
    if (!shown[i])
      continue;
    const StatusCell& cell = text.figures[i];
    canvas.text({x, top + 5 * u}, TextStyle::label, palette::quiet_text, cell.label);
    canvas.text({x, top + 33 * u}, TextStyle::value, colour_of(cell.tone), cell.value.view());
    x += width_of(canvas, cell) + gap;
  }
}

} // namespace octascope::ui
