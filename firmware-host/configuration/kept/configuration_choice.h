// Which configuration a run starts with if the requested one cannot be used.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "firmware-host/configuration/configuration.h"
#include "firmware-host/configuration/run_options.h"
#include "hal/result.h"
#include "ui/status/status.h"

namespace octascope::firmware_host {

struct ChosenConfiguration {
  Configuration configuration;
  ui::ConfigurationState state = ui::ConfigurationState::own;
  std::optional<std::filesystem::path> wanted; // the requested file, whether used or not
  std::optional<std::filesystem::path> used;   // the file in use; empty: the built-in defaults
  std::string refusal;                         // why the requested file is not used, in full
};

// The configuration file requested for a run. An appliance, which has a state folder, requests the
// machine's even if it does not exist.
std::optional<std::filesystem::path>
wanted_file(const RunOptions& options, const std::optional<std::filesystem::path>& state_folder);

// Without a state folder: the requested file or the Error. With one, a picture matters more than
// the right configuration: after the requested file come the last good one and then the built-in
// defaults; `state` and `refusal` are for the screen.
hal::Result<ChosenConfiguration>
choose_configuration(const RunOptions& options,
                     const std::optional<std::filesystem::path>& state_folder);

// The next choice after `chosen`, which could not be used for the reason `refusal`; empty after the
// last.
std::optional<ChosenConfiguration> next_choice(const ChosenConfiguration& chosen,
                                               const std::string& refusal,
                                               const RunOptions& options,
                                               const std::filesystem::path& state_folder);

// Why the file is not used, for the notice line, which often fits only forty letters; a badge says
// the rest. Empty if the requested file is used.
std::string configuration_notice(const ChosenConfiguration& chosen);

// A message without the folder of the file that it concerns, to save space.
std::string short_reason(std::string message, const std::filesystem::path& file);

} // namespace octascope::firmware_host
