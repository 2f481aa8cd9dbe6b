// Whether a user may open a device node, who holds it open, and the command that fixes it.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "firmware-host/devices/hardware_survey.h"

namespace octascope::firmware_host {

// One command that installs our udev rules.
extern const char* const install_rules_command;

// One command that starts udevd.
extern const char* const start_udev_command;

// Sets usable, why_not and remedy of `device` by its node under `root`.
void judge_access(FoundDevice& device, const std::filesystem::path& root, const Person& person);

// Which programs hold which nodes open, from `root`/proc: "/dev/video0" → "pipewire (812)". Only
// root sees other users' programs.
std::map<std::string, std::string> holders_of_nodes(const std::filesystem::path& root);

} // namespace octascope::firmware_host
