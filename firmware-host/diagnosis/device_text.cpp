#include "firmware-host/diagnosis/device_text.h"

#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace octascope::firmware_host {

namespace {

struct Section {
  const char* title;
  const char* key;
  const std::vector<FoundDevice>& devices;
};

std::vector<Section> sections(const HardwareSurvey& survey) {
  return {{"video (line and scope cameras)", "video", survey.video},
          {"media controllers (scope camera)", "media", survey.media},
          {"GPIO chips (galvo trigger)", "gpio", survey.gpio},
          {"HID devices (pedals, knobs)", "hid", survey.hid},
          {"input events (keyboard-type pedals, knobs)", "input", survey.input},
          {"graphics processors", "render", survey.render},
          {"display connectors", "displays", survey.displays}};
}

void write_device(std::string& text, const FoundDevice& device) {
  auto out = std::back_inserter(text);
  fmt::format_to(out, "    {:<16} {}", device.node, device.name);
  for (const auto& [key, value] : device.facts)
    fmt::format_to(out, ", {} {}", key, value);
  text += '\n';
  if (!device.usable)
    fmt::format_to(out, "    {:<16} not usable: {}\n    {:<16} → {}\n", "", device.why_not, "",
                   device.remedy);
  if (!device.held_by.empty())
    fmt::format_to(out, "    {:<16} open in {}: where it is busy, end that program\n", "",
                   device.held_by);
}

nlohmann::ordered_json to_json(const FoundDevice& device) {
  nlohmann::ordered_json json{{"node", device.node}, {"name", device.name}};
  for (const auto& [key, value] : device.facts)
    json[key] = value;
  json["usable"] = device.usable;
  if (!device.usable) {
    json["why_not"] = device.why_not;
    json["remedy"] = device.remedy;
    json["mend"] = device.remedy; // its old name
  }
  if (!device.held_by.empty())
    json["held_by"] = device.held_by;
  return json;
}

} // namespace

std::string devices_text(const HardwareSurvey& survey, const DeviceChoices& choices) {
  std::string text = "Plugged in\n";
  auto out = std::back_inserter(text);
  for (const Section& section : sections(survey)) {
    fmt::format_to(out, "  {}\n", section.title);
    if (section.devices.empty())
      text += "    none\n";
    for (const FoundDevice& device : section.devices)
      write_device(text, device);
  }
  for (const std::string& idle : survey.machine.without_driver)
    fmt::format_to(out, "  {}: plugged in, but no driver holds it: see octascope doctor\n", idle);
  text += "\nWould be used\n";
  for (const DeviceChoice& choice : choices.all())
    fmt::format_to(out, "  {:<14} {:<10} {}\n", facts_of(choice.device).key, choice.backend,
                   choice.reason);
  return text;
}

std::string devices_json(const HardwareSurvey& survey, const DeviceChoices& choices) {
  nlohmann::ordered_json json;
  for (const Section& section : sections(survey)) {
    auto& list = json["found"][section.key] = nlohmann::ordered_json::array();
    for (const FoundDevice& device : section.devices)
      list.push_back(to_json(device));
  }
  json["machine"] = {{"udev_runs", survey.machine.udev_runs},
                     {"udev_rules_installed", survey.machine.rules_installed},
                     {"without_driver", survey.machine.without_driver}};
  for (const DeviceChoice& choice : choices.all())
    json["used"][std::string{facts_of(choice.device).key}] = {{"backend", choice.backend},
                                                              {"reason", choice.reason}};
  return json.dump(2) + "\n";
}

} // namespace octascope::firmware_host
