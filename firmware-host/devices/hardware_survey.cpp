#include "firmware-host/devices/hardware_survey.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string_view>

#include <fmt/format.h>

#include "firmware-host/devices/node_access.h"
#include "hal/linux/gpio/gpio_lookup.h"
#include "hal/linux/kms/drm/edid.h"
#include "hal/linux/system/system_files.h"

namespace octascope::firmware_host {

namespace fs = std::filesystem;

using hal::linux_backend::entries;
using hal::linux_backend::first_line;
using hal::linux_backend::text_after;

namespace {

std::string node_of(const fs::path& entry, std::string_view folder = "/dev/") {
  return std::string{folder} + entry.filename().string();
}

// "0003:000005F3:000000FF" (bus, vendor, product) → "05f3:00ff"; empty for anything else.
std::string product_of(const std::string& hid_id) {
  unsigned bus = 0;
  unsigned vendor = 0;
  unsigned product = 0;
  if (std::sscanf(hid_id.c_str(), "%x:%x:%x", &bus, &vendor, &product) != 3)
    return {};
  return fmt::format("{:04x}:{:04x}", vendor & 0xFFFF, product & 0xFFFF);
}

void add_fact(FoundDevice& device, const char* key, std::string value) {
  if (!value.empty())
    device.facts.emplace_back(key, std::move(value));
}

// Its lines are asked for by its node, so of this machine alone.
FoundDevice gpio_chip(const fs::path& entry, const fs::path& root) {
  FoundDevice device{.node = node_of(entry), .name = text_after("OF_FULLNAME=", entry / "uevent")};
  if (root != "/")
    return device;
  if (const auto chip = hal::linux_backend::describe_gpio_chip(device.node)) {
    if (device.name.empty())
      device.name = chip->label;
    add_fact(device, "lines", hal::linux_backend::listed_lines(*chip));
  }
  return device;
}

std::string monitor_of(const fs::path& edid) {
  std::ifstream in{edid, std::ios::binary};
  const std::vector<char> bytes{std::istreambuf_iterator<char>{in}, {}};
  return hal::linux_backend::kms::monitor_name(
      {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

// A connector is used by way of its card: its node is judged, its cable, and what the monitor says.
FoundDevice connector(const fs::path& entry, const std::string& status, const fs::path& root,
                      const Person& person) {
  FoundDevice device{.node = entry.filename().string(), .name = status};
  add_fact(device, "monitor", monitor_of(entry / "edid"));
  const std::string mode = first_line(entry / "modes"); // the first is the preferred one
  add_fact(device, "mode", mode);
  add_fact(device, "lit", first_line(entry / "enabled"));
  FoundDevice card{.node = "/dev/dri/" + device.node.substr(0, device.node.find('-')), .name = {}};
  add_fact(device, "card", card.node);
  judge_access(card, root, person);
  device.usable = card.usable;
  device.why_not = card.usable ? "" : fmt::format("{}: {}", card.node, card.why_not);
  device.remedy = card.remedy;
  if (status == "disconnected") {
    device.usable = false;
    device.why_not = "no monitor is plugged in, or it is switched off";
    device.remedy = "check cable and monitor";
  } else if (status == "connected" && device.usable && mode.empty()) {
    device.usable = false;
    device.why_not = "the monitor tells no mode that it can show";
    device.remedy = "try another cable; or say the mode in the configuration: [devices] mode = "
                    "\"1920x1080@60\"";
  }
  return device;
}

std::vector<std::string> interfaces_without_driver(const fs::path& sys) {
  std::vector<std::string> idle;
  for (const fs::path& entry : entries(sys / "bus/usb/devices")) {
    const std::string kind = first_line(entry / "bInterfaceClass");
    std::error_code error;
    if (fs::exists(entry / "driver", error))
      continue;
    if (kind == "0e" && first_line(entry / "bInterfaceSubClass") == "01") // video, its control
      idle.push_back("USB camera " + entry.filename().string());
    else if (kind == "03")
      idle.push_back("USB HID device " + entry.filename().string());
  }
  return idle;
}

bool has_graphics_card(const fs::path& sys) {
  for (const fs::path& entry : entries(sys / "bus/pci/devices"))
    if (first_line(entry / "class").starts_with("0x03"))
      return true;
  return false;
}

bool rules_installed(const fs::path& root) {
  for (const char* folder : {"etc/udev/rules.d", "usr/lib/udev/rules.d", "lib/udev/rules.d",
                             "usr/local/lib/udev/rules.d", "run/udev/rules.d"})
    for (const fs::path& file : entries(root / folder))
      if (file.filename().string().find("octascope") != std::string::npos)
        return true;
  return false;
}

MachineFacts machine_facts(const fs::path& root) {
  const fs::path sys = root / "sys";
  MachineFacts facts;
  std::error_code error;
  facts.udev_runs = fs::exists(root / "run/udev/control", error);
  facts.rules_installed = rules_installed(root);
  facts.without_driver = interfaces_without_driver(sys);
  facts.has_graphics_card = has_graphics_card(sys);
  facts.has_graphics_driver =
      !facts.has_graphics_card || !entries(sys / "class/drm", "card").empty();
  return facts;
}

} // namespace

bool has_window_system() {
  return std::getenv("WAYLAND_DISPLAY") != nullptr || std::getenv("DISPLAY") != nullptr;
}

HardwareSurvey survey_hardware(const fs::path& root, const Person& person) {
  const fs::path sys = root / "sys";
  const auto holders = holders_of_nodes(root);
  HardwareSurvey survey;
  const auto add = [&](std::vector<FoundDevice>& list, FoundDevice device) {
    judge_access(device, root, person);
    if (const auto holder = holders.find(device.node); holder != holders.end())
      device.held_by = holder->second;
    list.push_back(std::move(device));
  };
  for (const fs::path& entry : entries(sys / "class/video4linux", "video"))
    add(survey.video, {.node = node_of(entry), .name = first_line(entry / "name")});
  for (const fs::path& entry : entries(sys / "bus/media/devices", "media"))
    add(survey.media, {.node = node_of(entry), .name = first_line(entry / "model")});
  for (const fs::path& entry : entries(sys / "bus/gpio/devices", "gpiochip"))
    add(survey.gpio, gpio_chip(entry, root));
  for (const fs::path& entry : entries(sys / "class/hidraw", "hidraw")) {
    FoundDevice device{.node = node_of(entry),
                       .name = text_after("HID_NAME=", entry / "device/uevent")};
    add_fact(device, "product", product_of(text_after("HID_ID=", entry / "device/uevent")));
    add(survey.hid, std::move(device));
  }
  for (const fs::path& entry : entries(sys / "class/input", "event")) {
    FoundDevice device{.node = node_of(entry, "/dev/input/"),
                       .name = first_line(entry / "device/name")};
    const std::string vendor = first_line(entry / "device/id/vendor");
    const std::string product = first_line(entry / "device/id/product");
    if (!vendor.empty() && !product.empty())
      add_fact(device, "product", vendor + ":" + product);
    add(survey.input, std::move(device));
  }
  for (const fs::path& entry : entries(sys / "class/drm", "renderD")) {
    std::error_code error;
    add(survey.render,
        {.node = node_of(entry, "/dev/dri/"),
         .name = fs::read_symlink(entry / "device/driver", error).filename().string()});
  }
  for (const fs::path& entry : entries(sys / "class/drm", "card")) {
    const std::string status = first_line(entry / "status"); // connectors alone have one
    const bool shows_something = entry.filename().string().find("Writeback") == std::string::npos;
    if (status.empty() || !shows_something)
      continue;
    FoundDevice device = connector(entry, status, root, person);
    const auto card = "/dev/dri/" + device.node.substr(0, device.node.find('-'));
    if (const auto holder = holders.find(card); holder != holders.end())
      device.held_by = holder->second;
    survey.displays.push_back(std::move(device));
  }
  survey.has_window_system = has_window_system();
  survey.machine = machine_facts(root);
  return survey;
}

} // namespace octascope::firmware_host
