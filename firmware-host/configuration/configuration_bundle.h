// A configuration and every file that it names, held in memory.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "firmware-host/configuration/configuration.h"
#include "hal/result.h"

namespace octascope::firmware_host {

// Files by name in one flat folder; references in the texts are rewritten to match.
class ConfigurationBundle {
public:
  static constexpr const char* main_file = "octascope.toml";

  // Reads the files as they are now. Error: the configuration is refused, or a file cannot be read.
  static hal::Result<ConfigurationBundle> gather(const std::filesystem::path& configuration);

  // The same for a calibration and its tables alone.
  static hal::Result<ConfigurationBundle>
  gather_calibration(const std::filesystem::path& calibration);

  // Reads such a folder; an Error if it holds anything but files.
  static hal::Result<ConfigurationBundle> read(const std::filesystem::path& folder);

  // Into an existing folder; everything is on disk when this returns.
  hal::Result<> write(const std::filesystem::path& folder) const;

  const std::map<std::string, std::string>& files() const { return files_; }
  bool operator==(const ConfigurationBundle&) const = default;

private:
  hal::Result<> add_with_its_files(const pipeline::ConfigDocument& document,
                                   const std::string& name, const Configuration* configuration);

  std::map<std::string, std::string> files_;
};

} // namespace octascope::firmware_host
