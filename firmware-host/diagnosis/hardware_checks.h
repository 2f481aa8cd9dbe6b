// What the survey of the hardware means for the appliance: the part of `doctor` that concerns
// devices. Pure.
#pragma once

#include <vector>

#include "firmware-host/devices/hardware_survey.h"
#include "firmware-host/diagnosis/health_check.h"

namespace octascope::firmware_host {

// udev, its rules, drivers, permissions, programs in the way, and the display.
std::vector<HealthCheck> check_hardware(const HardwareSurvey& survey);

} // namespace octascope::firmware_host
