// octascope devices: what hardware is there, which backend or twin would be used, and why.
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "firmware-host/commands/command.h"
#include "firmware-host/device_choice.h"

namespace octascope::firmware_host {

namespace {

struct Section {
  const char* title;
  const char* key;
  const std::vector<FoundDevice>& devices;
};

std::vector<Section> sections(const HardwareSurvey& survey) {
  return {{"video (line and scope cameras)", "video", survey.video},
          {"GPIO chips (galvo trigger)", "gpio", survey.gpio},
          {"HID devices (pedals, knobs)", "hid", survey.hid},
          {"display connectors", "displays", survey.displays}};
}

void print_text(const HardwareSurvey& survey, const DeviceChoices& choices) {
  fmt::print("Plugged in\n");
  for (const Section& section : sections(survey)) {
    fmt::print("  {}\n", section.title);
    if (section.devices.empty())
      fmt::print("    none\n");
    for (const FoundDevice& device : section.devices)
      fmt::print("    {:<16} {}\n", device.node, device.name);
  }
  fmt::print("\nWould be used\n");
  for (const DeviceChoice& choice : choices.all())
    fmt::print("  {:<14} {:<10} {}\n", choice.device, choice.backend, choice.reason);
}

void print_json(const HardwareSurvey& survey, const DeviceChoices& choices) {
  nlohmann::ordered_json json;
  for (const Section& section : sections(survey)) {
    auto& list = json["found"][section.key] = nlohmann::ordered_json::array();
    for (const FoundDevice& device : section.devices)
      list.push_back({{"node", device.node}, {"name", device.name}});
  }
  for (const DeviceChoice& choice : choices.all())
    json["used"][std::string{choice.device}] = {{"backend", choice.backend},
                                                {"reason", choice.reason}};
  fmt::print("{}\n", json.dump(2));
}

} // namespace

void add_devices_command(CLI::App& program, int& exit_status) {
  auto as_json = std::make_shared<bool>(false);
  CLI::App* command = program.add_subcommand(
      "devices", "What hardware is there, which backend or twin would be used, and why");
  command->footer("Example: octascope devices --json");
  command->add_flag("--json", *as_json, "One JSON object");
  command->callback([as_json, &exit_status] {
    const HardwareSurvey survey = survey_hardware();
    const DeviceChoices choices = choose_devices(survey, RunOptions{});
    if (*as_json)
      print_json(survey, choices);
    else
      print_text(survey, choices);
    exit_status = exit_done;
  });
}

} // namespace octascope::firmware_host
