// Which configuration a run begins with, when the one that was asked for cannot be used.
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
  std::optional<std::filesystem::path> wanted; // the file that was asked for, whether used or not
  std::optional<std::filesystem::path> used;   // the file that configures; none: what is built in
  std::string refusal;                         // why that one is not used, in full
};

// The file that a run is to be configured by. An appliance, which has a folder to keep things in,
// wants the machine's even where there is none.
std::optional<std::filesystem::path>
wanted_file(const RunOptions& options, const std::optional<std::filesystem::path>& state_folder);

// Without a folder to keep things in, the file that was asked for or the Error. With one, a picture
// is worth more than the right configuration: after the file itself the last one that worked is
// tried, and then what is built in; `state` and `refusal` are for the screen.
hal::Result<ChosenConfiguration>
choose_configuration(const RunOptions& options,
                     const std::optional<std::filesystem::path>& state_folder);

// The next choice after `chosen`, which could not be used for that reason; nothing after the last.
std::optional<ChosenConfiguration> next_choice(const ChosenConfiguration& chosen,
                                               const std::string& refusal,
                                               const RunOptions& options,
                                               const std::filesystem::path& state_folder);

// Why the file is not used, for the notice line, which often has room for forty letters: a badge
// says the rest. Empty for the own one.
std::string configuration_notice(const ChosenConfiguration& chosen);

// A message without the folder of the file that it is about: what there is room for.
std::string short_reason(std::string message, const std::filesystem::path& file);

} // namespace octascope::firmware_host
