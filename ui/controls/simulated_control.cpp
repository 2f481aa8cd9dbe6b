#include "ui/controls/simulated_control.h"

namespace octascope::ui {

std::optional<hal::ControlEvent> simulated_control(const hal::DisplayEvent& event) {
  const bool pressed = event.kind == hal::DisplayEventKind::key_pressed;
  if (!pressed && event.kind != hal::DisplayEventKind::key_released)
    return std::nullopt;
  if (event.key >= '1' && event.key <= '3' && !event.repeated)
    return hal::ControlEvent{event.time, hal::ControlKind::pedal_switch,
                             static_cast<std::uint8_t>(event.key - '1'), pressed ? 1 : 0};
  if (pressed && (event.key == ',' || event.key == '.'))
    return hal::ControlEvent{event.time, hal::ControlKind::knob, 0, event.key == '.' ? 1 : -1};
  return std::nullopt;
}

} // namespace octascope::ui
