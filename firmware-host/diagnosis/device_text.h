// What is plugged in and what serves, as text and as JSON: the output of `devices`.
#pragma once

#include <string>

#include "firmware-host/devices/device_choice.h"
#include "firmware-host/devices/hardware_survey.h"

namespace octascope::firmware_host {

std::string devices_text(const HardwareSurvey& survey, const DeviceChoices& choices);

// {"found": {"video": [{"node", "name", "usable", "why_not", "remedy", "held_by", …facts}], …},
//  "machine": {…}, "used": {"line_camera": {"backend", "reason"}, …}}
std::string devices_json(const HardwareSurvey& survey, const DeviceChoices& choices);

} // namespace octascope::firmware_host
