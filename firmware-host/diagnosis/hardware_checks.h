// What the hardware survey means for the appliance: the device part of `doctor`. Pure.
#pragma once

#include <vector>

#include "firmware-host/devices/hardware_survey.h"
#include "firmware-host/diagnosis/health_check.h"

namespace octascope::firmware_host {

// udev, its rules, drivers, permissions, programs in the way, and the display.
std::vector<HealthCheck> check_hardware(const HardwareSurvey& survey);

} // namespace octascope::firmware_host
