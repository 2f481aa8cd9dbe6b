// Which keys stand for the simulated pedal and knob.
#pragma once

#include <optional>

#include "hal/control_input.h"
#include "hal/display.h"

namespace octascope::ui {

// 1 2 3: the left, centre and right switch, down as long as the key is; comma and full stop: the
// knob, one detent left and right. Empty for other keys. Pure; the host passes the event to the
// pedal's twin.
std::optional<hal::ControlEvent> simulated_control(const hal::DisplayEvent& event);

} // namespace octascope::ui
