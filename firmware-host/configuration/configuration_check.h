// Whether a configuration can be run on, with every file that it names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "firmware-host/configuration/configuration.h"
#include "firmware-host/configuration/run_options.h"
#include "hal/result.h"

namespace octascope::firmware_host {

// Reads every file that the configuration names, those of objectives that are not on the microscope
// included, and compares what must agree. The first that is wrong, with file, line, what was found
// and what was expected.
hal::Result<> check_named_files(const Configuration& configuration, const RunOptions& options = {});

// load_configuration(), and that.
hal::Result<Configuration> load_whole_configuration(const std::filesystem::path& file,
                                                    const RunOptions& options = {});

// Everything that is wrong with the file and with what it names, for people who fix it; empty: it
// can be run on.
std::vector<std::string> configuration_complaints(const std::filesystem::path& file);

} // namespace octascope::firmware_host
