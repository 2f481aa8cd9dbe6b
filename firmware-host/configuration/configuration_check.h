// Whether a configuration is usable, with every file that it names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "firmware-host/configuration/configuration.h"
#include "firmware-host/configuration/run_options.h"
#include "hal/result.h"

namespace octascope::firmware_host {

// Reads every file that the configuration names, including those of objectives not on the
// microscope, and checks that they agree. Returns the first error, with file, line, what was found
// and what was expected.
hal::Result<> check_named_files(const Configuration& configuration, const RunOptions& options = {});

// load_configuration() followed by check_named_files().
hal::Result<Configuration> load_whole_configuration(const std::filesystem::path& file,
                                                    const RunOptions& options = {});

// Everything wrong with the file and the files it names, for people who fix it; empty: usable.
std::vector<std::string> configuration_complaints(const std::filesystem::path& file);

} // namespace octascope::firmware_host
