// Which HID devices are plugged in: those with raw reports as hidapi lists them, input devices by
// what the kernel lists in /sys; nothing is opened. And which of them octascope knows.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hal/linux/hid/models/control_model.h"

namespace octascope::hal::linux_backend {

// A file through which a device speaks; a device may have several.
struct HidNode {
  std::string node; // "/dev/hidraw0", "/dev/input/event3"
  bool evdev = false;
  std::uint16_t vendor = 0, product = 0;
  std::string name;   // what the device calls itself
  std::string device; // the same for all nodes of one device, where the kernel knows
  bool operator==(const HidNode&) const = default;
};

// Raw nodes, then event nodes, each in the order of their numbers. `root` is "/" but for tests,
// which lay out a folder like /sys.
std::vector<HidNode> survey_hid(const std::filesystem::path& root = "/");

// A device that octascope knows, with its files.
struct PluggedControl {
  ControlModel model;
  std::vector<HidNode> nodes; // of the kind that the model speaks through; not empty
  bool operator==(const PluggedControl&) const = default;
};

// In the order of `models`; equal ones in that of their nodes. Pure.
std::vector<PluggedControl> known_controls(const std::vector<HidNode>& nodes,
                                           const std::vector<ControlModel>& models);

} // namespace octascope::hal::linux_backend
