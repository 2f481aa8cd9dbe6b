#include "hal/linux/hid/survey/hid_survey.h"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <optional>
#include <string_view>

#include "hal/linux/hid/raw/raw_device.h"

namespace octascope::hal::linux_backend {

namespace fs = std::filesystem;

namespace {

template <class Number> std::optional<Number> number(std::string_view text, int base) {
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, base);
  if (error != std::errc{} || end != text.data() + text.size())
    return std::nullopt;
  return value;
}

std::string first_line(const fs::path& file) {
  std::ifstream in{file};
  std::string line;
  std::getline(in, line);
  return line;
}

// Folders named `prefix` and a number, in the order of the numbers.
std::vector<fs::path> numbered(const fs::path& folder, std::string_view prefix) {
  std::vector<std::pair<unsigned, fs::path>> found;
  std::error_code error;
  for (fs::directory_iterator it{folder, error}, end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (!name.starts_with(prefix))
      continue;
    if (const auto n = number<unsigned>(std::string_view{name}.substr(prefix.size()), 10))
      found.emplace_back(*n, it->path());
  }
  std::ranges::sort(found);
  std::vector<fs::path> paths;
  for (auto& [n, path] : found)
    paths.push_back(std::move(path));
  return paths;
}

// "usb-0000:00:14.0-1/input0" and …/input1 are one device; what says nothing is one of its own.
std::string device_of(const std::string& phys, const std::string& node) {
  return phys.empty() ? node : phys.substr(0, phys.rfind('/'));
}

// hidapi knows nothing of the plug, and leaves the maker or what is not ASCII out of names.
HidNode raw_node(const RawNode& raw, const fs::path& root) {
  HidNode node{
      .node = raw.node, .vendor = raw.vendor, .product = raw.product, .name = {}, .device = {}};
  std::ifstream uevent{root / "sys/class/hidraw" / fs::path{raw.node}.filename() / "device/uevent"};
  constexpr std::string_view name_key = "HID_NAME=", phys_key = "HID_PHYS=";
  std::string phys;
  for (std::string line; std::getline(uevent, line);) {
    if (line.starts_with(name_key))
      node.name = line.substr(name_key.size());
    else if (line.starts_with(phys_key))
      phys = line.substr(phys_key.size());
  }
  node.device = device_of(phys, node.node);
  return node;
}

HidNode event_node(const fs::path& entry) {
  const fs::path id = entry / "device/id";
  HidNode node{
      .node = "/dev/input/" + entry.filename().string(),
      .evdev = true,
      .vendor = number<std::uint16_t>(first_line(id / "vendor"), 16).value_or(std::uint16_t{0}),
      .product = number<std::uint16_t>(first_line(id / "product"), 16).value_or(std::uint16_t{0}),
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
  for (const fs::path& entry : numbered(root / "sys/class/input", "event"))
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
