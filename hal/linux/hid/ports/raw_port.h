// A control with raw reports, through hidapi.
#pragma once

#include "hal/linux/hid/ports/control_port.h"

namespace octascope::hal::linux_backend {

Result<std::unique_ptr<ControlPort>> open_raw_port(const HidNode& node, const ControlModel& model);

} // namespace octascope::hal::linux_backend
