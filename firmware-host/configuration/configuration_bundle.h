// A configuration with every file that it names, held together.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "firmware-host/configuration/configuration.h"
#include "hal/result.h"

namespace octascope::firmware_host {

// Files by their names in one flat folder; the texts name each other as they lie there.
class ConfigurationBundle {
public:
  static constexpr const char* main_file = "octascope.toml";

  // As the files are now. An Error for a configuration that is refused, or a file that cannot be
  // read.
  static hal::Result<ConfigurationBundle> gather(const std::filesystem::path& configuration);

  // A calibration with its tables alone.
  static hal::Result<ConfigurationBundle>
  gather_calibration(const std::filesystem::path& calibration);

  // What lies in such a folder; an Error where it holds anything but files.
  static hal::Result<ConfigurationBundle> read(const std::filesystem::path& folder);

  // Into an existing folder; all of it is on the disk when this returns.
  hal::Result<> write(const std::filesystem::path& folder) const;

  const std::map<std::string, std::string>& files() const { return files_; }
  bool operator==(const ConfigurationBundle&) const = default;

private:
  hal::Result<> add_with_its_files(const pipeline::ConfigDocument& document,
                                   const std::string& name, const Configuration* configuration);

  std::map<std::string, std::string> files_;
};

} // namespace octascope::firmware_host
