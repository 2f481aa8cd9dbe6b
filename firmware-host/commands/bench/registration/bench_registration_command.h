// octascope bench registration.
#pragma once

#include <CLI/App.hpp>

namespace octascope::firmware_host {

// `exit_status` as in add_run_command().
void add_bench_registration_command(CLI::App& bench, int& exit_status);

} // namespace octascope::firmware_host
