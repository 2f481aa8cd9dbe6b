// The keys that simulate the pedal and the knob.
#pragma once

#include <optional>

#include "hal/control_input.h"
#include "hal/display.h"

namespace octascope::ui {

// 1 2 3: the left, centre and right switch, down while the key is down; comma and full stop: the
// knob, one detent left or right. Empty for all other keys. Pure; the host passes the event to the
// simulated pedal.
std::optional<hal::ControlEvent> simulated_control(const hal::DisplayEvent& event);

} // namespace octascope::ui
