// An input device, through libevdev: a pedal that acts as a keyboard, or a PowerMate.
#pragma once

#include "hal/linux/hid/ports/control_port.h"

namespace octascope::hal::linux_backend {

// ErrorCode::busy: another program has grabbed it.
Result<std::unique_ptr<ControlPort>> open_evdev_port(const HidNode& node,
                                                     const ControlModel& model);

} // namespace octascope::hal::linux_backend
