#include "hal/linux/hid/survey/hid_survey.h"

#include <algorithm>
#include <string_view>

#include "hal/linux/hid/raw/raw_device.h"
#include "hal/linux/system/system_files.h"
#include "hal/number_text.h"

namespace octascope::hal::linux_backend {

namespace fs = std::filesystem;

namespace {

std::uint16_t hex_of(const fs::path& file) {
  return number_of<std::uint16_t>(first_line(file), 16).value_or(std::uint16_t{0});
}

// "usb-0000:00:14.0-1/input0" and …/input1 are one device; what says nothing is one of its own.
std::string device_of(const std::string& phys, const std::string& node) {
  return phys.empty() ? node : phys.substr(0, phys.rfind('/'));
}

// hidapi knows nothing of the plug, and leaves the maker or what is not ASCII out of names.
HidNode raw_node(const RawNode& raw, const fs::path& root) {
  HidNode node{
      .node = raw.node, .vendor = raw.vendor, .product = raw.product, .name = {}, .device = {}};
  const fs::path uevent =
      root / "sys/class/hidraw" / fs::path{raw.node}.filename() / "device/uevent";
  node.name = text_after("HID_NAME=", uevent);
  node.device = device_of(text_after("HID_PHYS=", uevent), node.node);
  return node;
}

HidNode event_node(const fs::path& entry) {
  const fs::path id = entry / "device/id";
  HidNode node{.node = "/dev/input/" + entry.filename().string(),
               .evdev = true,
               .vendor = hex_of(id / "vendor"),
               .product = hex_of(id / "product"),
               .name = first_line(entry / "device/name"),
               .device = {}};
  node.device = device_of(first_line(entry / "device/phys"), node.node);
  return node;
}

bool fits(const HidNode& node, const ControlModel& model) {
  return node.vendor == model.vendor && node.product == model.product &&
         node.evdev == model.by_evdev() && node.name.find(model.product_has) != std::string::npos;
}

} // namespace

std::vector<HidNode> survey_hid(const fs::path& root) {
  std::vector<HidNode> nodes;
  for (const RawNode& raw : list_raw_nodes())
    nodes.push_back(raw_node(raw, root));
  for (const std::string& entry : numbered_entries(root / "sys/class/input", "event"))
    nodes.push_back(event_node(entry));
  return nodes;
}

std::vector<PluggedControl> known_controls(const std::vector<HidNode>& nodes,
                                           const std::vector<ControlModel>& models) {
  std::vector<PluggedControl> plugged;
  std::vector<bool> taken(nodes.size());
  for (const ControlModel& model : models) {
    const std::size_t first = plugged.size();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (taken[i] || !fits(nodes[i], model))
        continue;
      taken[i] = true;
      const auto same = std::find_if(
          plugged.begin() + static_cast<std::ptrdiff_t>(first), plugged.end(),
          [&](const PluggedControl& other) { return other.nodes[0].device == nodes[i].device; });
      if (same != plugged.end())
        same->nodes.push_back(nodes[i]);
      else
        plugged.push_back({model, {nodes[i]}});
    }
  }
  return plugged;
}

} // namespace octascope::hal::linux_backend
