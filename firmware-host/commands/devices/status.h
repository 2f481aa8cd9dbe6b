// octascope status: prints the state of a running appliance.
#pragma once

#include <CLI/App.hpp>

namespace octascope::firmware_host {

// Adds itself to the command line, as command.h says.
void add_status_command(CLI::App& program, int& exit_status);

} // namespace octascope::firmware_host
