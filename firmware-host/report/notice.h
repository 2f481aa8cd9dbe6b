// The display's notice line: what is wrong just now.
#pragma once

#include <span>
#include <string_view>

#include "hal/clock.h"
#include "pipeline/faults/fault_log.h"
#include "ui/status/status.h"

namespace octascope::firmware_host {

// Pure; returns a literal, empty if nothing is wrong. A lost device is named as long as it is lost,
// a restart after a crash for a minute, any other fault until two seconds after it last struck. Of
// several faults the gravest is named rather than the newest, so that the line does not flicker.
std::string_view compose_notice(std::span<const pipeline::FaultRecord> faults,
                                std::span<const ui::DeviceStatus> devices, hal::TimePoint now);

} // namespace octascope::firmware_host
