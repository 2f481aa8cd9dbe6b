// The one line of the display that says what is wrong just now.
#pragma once

#include <span>
#include <string_view>

#include "hal/clock.h"
#include "pipeline/faults/fault_log.h"
#include "ui/status/status.h"

namespace octascope::firmware_host {

// Pure; returns a literal, empty when nothing is wrong. A device that went away is named for as
// long as it is away, a restart after a crash for a minute, any other fault until two seconds after
// it last struck. Of several the gravest is named, not the newest, so that the line does not
// flicker between them.
std::string_view compose_notice(std::span<const pipeline::FaultRecord> faults,
                                std::span<const ui::DeviceStatus> devices, hal::TimePoint now);

} // namespace octascope::firmware_host
