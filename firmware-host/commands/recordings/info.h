// octascope info: what a recording is.
#pragma once

#include <CLI/CLI.hpp>

namespace octascope::firmware_host {

void add_info_command(CLI::App& program, int& exit_status);

} // namespace octascope::firmware_host
