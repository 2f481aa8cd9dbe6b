// What the real devices could serve: found by asking them (real_devices.h), or set by a test.
#pragma once

#include <string>

namespace octascope::firmware_host {

struct DeviceFinding {
  bool usable = false;
  std::string what; // for people: the device, or what is missing and how to fix it
};

struct DetectedDevices {
  DeviceFinding line_camera;
  DeviceFinding galvo_trigger;
  DeviceFinding control_input;
  DeviceFinding scope_camera;
  DeviceFinding console_display;
  bool has_window_system = false; // X11 or Wayland, by the environment
};

} // namespace octascope::firmware_host
