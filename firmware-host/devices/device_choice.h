// Which backend serves each device, and why: the only place that chooses between a real device and
// its twin. `run` follows it, `devices` prints it.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "firmware-host/configuration/device_config.h"
#include "firmware-host/configuration/run_options.h"
#include "firmware-host/devices/detected_devices.h"
#include "hal/linux/aravis/genicam_address.h"
#include "pipeline/faults/fault.h"

namespace octascope::firmware_host {

struct DeviceChoice {
  pipeline::Device device{};
  std::string_view backend{}; // "v4l2", "sim", "window" …; "none"
  std::string reason{};       // for people
};

struct DeviceChoices {
  DeviceChoice line_camera{pipeline::Device::line_camera};
  DeviceChoice galvo_trigger{pipeline::Device::galvo_trigger};
  DeviceChoice control_input{pipeline::Device::control_input};
  DeviceChoice scope_camera{pipeline::Device::scope_camera};
  DeviceChoice display{pipeline::Device::display};

  std::vector<DeviceChoice> all() const {
    return {line_camera, galvo_trigger, control_input, scope_camera, display};
  }
};

// No twin contributes to the picture beside a real line camera: where the spectra are the
// patient's, so is the microscope's picture, or there is none. A real line camera is triggered by a
// real line, a simulated one by its twin; a pedal works with either.
DeviceChoices choose_devices(const DetectedDevices& detected, const RunOptions& options,
                             const DeviceConfig& config = {});

// Whether a line camera's backend is none of sim's.
bool is_camera_backend(std::string_view backend);

// The GenICam camera that [devices] line_camera names, if it names one.
std::optional<hal::linux_backend::GenicamAddress> genicam_address(std::string_view wanted);

// Whether the line camera's twin serves only because no real one was found: one plugged in later is
// then used.
bool camera_may_come(const DeviceChoices& choices, const RunOptions& options,
                     const DeviceConfig& config);

} // namespace octascope::firmware_host
