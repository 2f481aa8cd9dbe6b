// Lists the HID devices that are plugged in, without opening them (those with raw reports from
// hidapi, input devices from /sys), and those of them that octascope knows.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hal/linux/hid/models/control_model.h"

namespace octascope::hal::linux_backend {

// A device node. A device may have several.
struct HidNode {
  std::string node; // "/dev/hidraw0", "/dev/input/event3"
  bool evdev = false;
  std::uint16_t vendor = 0, product = 0;
  std::string name;   // as reported by the device
  std::string device; // the same for all nodes of one device, if the kernel knows
  bool operator==(const HidNode&) const = default;
};

// Raw nodes, then event nodes, each by number. `root` differs from "/" only in tests, which provide
// a folder like /sys.
std::vector<HidNode> survey_hid(const std::filesystem::path& root = "/");

// A known device with its nodes.
struct PluggedControl {
  ControlModel model;
  std::vector<HidNode> nodes; // of the kind that the model uses; not empty
  bool operator==(const PluggedControl&) const = default;
};

// In the order of `models`; devices of the same model in the order of their nodes. Pure.
std::vector<PluggedControl> known_controls(const std::vector<HidNode>& nodes,
                                           const std::vector<ControlModel>& models);

} // namespace octascope::hal::linux_backend
