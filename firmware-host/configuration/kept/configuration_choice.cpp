#include "firmware-host/configuration/kept/configuration_choice.h"

#include "firmware-host/configuration/configuration_check.h"
#include "firmware-host/configuration/kept/last_good.h"

namespace octascope::firmware_host {

namespace fs = std::filesystem;
using ui::ConfigurationState;

std::optional<fs::path> wanted_file(const RunOptions& options,
                                    const std::optional<fs::path>& state_folder) {
  auto file = configuration_file(options);
  if (!file && state_folder && !options.simulate && !options.recording)
    file = machine_configuration;
  return file;
}

hal::Result<ChosenConfiguration> choose_configuration(const RunOptions& options,
                                                      const std::optional<fs::path>& state_folder) {
  ChosenConfiguration own;
  own.wanted = wanted_file(options, state_folder);
  if (!state_folder) {
    if (own.wanted) {
      HAL_TRY(auto read, load_whole_configuration(*own.wanted, options));
      own.configuration = std::move(read);
    }
    own.used = own.wanted;
    return own;
  }
  if (!own.wanted) // a simulation: the same on every machine
    return own;
  auto read = load_whole_configuration(*own.wanted, options);
  if (!read)
    return *next_choice(own, read.error().message, options, *state_folder);
  own.configuration = std::move(*read);
  own.used = own.wanted;
  return own;
}

std::optional<ChosenConfiguration> next_choice(const ChosenConfiguration& chosen,
                                               const std::string& refusal,
                                               const RunOptions& options,
                                               const fs::path& state_folder) {
  if (chosen.state == ConfigurationState::built_in || !chosen.wanted)
    return std::nullopt;
  ChosenConfiguration next;
  next.wanted = chosen.wanted;
  next.refusal = chosen.state == ConfigurationState::own ? refusal : chosen.refusal;
  if (const auto file = LastGood{state_folder}.file();
      file && chosen.state == ConfigurationState::own) {
    if (auto read = load_whole_configuration(*file, options)) {
      next.configuration = std::move(*read);
      next.state = ConfigurationState::last_good;
      next.used = file;
      return next;
    }
  }
  next.state = ConfigurationState::built_in;
  return next;
}

std::string short_reason(std::string message, const fs::path& file) {
  message = message.substr(0, message.find('\n')); // of several faults, the first
  if (!file.has_parent_path())
    return message;
  const std::string folder = file.parent_path().string() + "/";
  for (std::size_t at = message.find(folder); at != std::string::npos; at = message.find(folder))
    message.erase(at, folder.size());
  return message;
}

std::string configuration_notice(const ChosenConfiguration& chosen) {
  return chosen.state == ConfigurationState::own ? std::string{}
                                                 : short_reason(chosen.refusal, *chosen.wanted);
}

} // namespace octascope::firmware_host
