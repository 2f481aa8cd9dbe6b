// Whether a configuration is usable, with every file that it names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "firmware-host/configuration/configuration.h"
#include "firmware-host/configuration/run_options.h"
#include "hal/result.h"

namespace octascope::firmware_host {

// Reads the file and every file that it names, those of objectives not on the microscope included,
// and checks that they agree. The error has all that is wrong, a line each, in the order of the file.
hal::Result<Configuration> load_whole_configuration(const std::filesystem::path& file,
                                                    const RunOptions& options = {});

// The files that a configuration or a calibration names, and those that its calibrations name; none
// of a file that cannot be read.
std::vector<std::filesystem::path> files_of_configuration(const std::filesystem::path& file);
std::vector<std::filesystem::path> files_of_calibration(const std::filesystem::path& file);

// What load_whole_configuration() says is wrong, one by one; empty: usable.
std::vector<std::string> configuration_complaints(const std::filesystem::path& file);

} // namespace octascope::firmware_host
