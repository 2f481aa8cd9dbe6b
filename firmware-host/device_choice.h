// Which backend serves each device, and why: the one place that decides between a real device and
// its twin. `run` follows it, `devices` prints it.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "firmware-host/hardware_survey.h"
#include "firmware-host/run_options.h"

namespace octascope::firmware_host {

struct DeviceChoice {
  std::string_view device;  // "line_camera" …
  std::string_view backend; // "sim", "window", "offscreen" …
  std::string reason;       // for people
};

struct DeviceChoices {
  DeviceChoice line_camera, galvo_trigger, control_input, scope_camera, display;

  std::vector<DeviceChoice> all() const {
    return {line_camera, galvo_trigger, control_input, scope_camera, display};
  }
};

DeviceChoices choose_devices(const HardwareSurvey& survey, const RunOptions& options);

} // namespace octascope::firmware_host
