// What hardware is plugged in, as the kernel lists it: nothing is opened.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace octascope::firmware_host {

struct FoundDevice {
  std::string node; // "/dev/video0"
  std::string name; // what the kernel calls it
};

struct HardwareSurvey {
  std::vector<FoundDevice> video;    // V4L2 nodes: line cameras, frame grabbers, scope cameras
  std::vector<FoundDevice> gpio;     // GPIO chips
  std::vector<FoundDevice> hid;      // raw HID devices: pedals, knobs, pucks
  std::vector<FoundDevice> displays; // connectors of display controllers, with their status
  bool has_window_system = false;    // X11 or Wayland, by the environment
};

// `root` is "/" but for tests, which lay out a folder like /sys and /dev.
HardwareSurvey survey_hardware(const std::filesystem::path& root = "/");

} // namespace octascope::firmware_host
