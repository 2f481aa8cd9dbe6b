// octascope vessels: vessel trees, their files and their pictures.
#pragma once

#include <CLI/App.hpp>

namespace octascope::firmware_host {

// Adds "vessels" with its subcommands; see add_run_command() for `exit_status`.
void add_vessels_command(CLI::App& program, int& exit_status);

// One subcommand each.
void add_vessels_convert_command(CLI::App& vessels, int& exit_status);
void add_vessels_generate_command(CLI::App& vessels, int& exit_status);
void add_vessels_info_command(CLI::App& vessels, int& exit_status);
void add_vessels_render_command(CLI::App& vessels, int& exit_status);
void add_vessels_bench_command(CLI::App& vessels, int& exit_status);
void add_vessels_register_command(CLI::App& vessels, int& exit_status);
void add_vessels_trace_command(CLI::App& vessels, int& exit_status);

// "vessels", of "bench".
void add_bench_vessels_command(CLI::App& bench, int& exit_status);

} // namespace octascope::firmware_host
