// octascope bench: how fast this machine does it.
#pragma once

#include <CLI/App.hpp>

namespace octascope::firmware_host {

// Adds "bench" and returns it, so that other folders can add subcommands; `exit_status` as in
// add_run_command().
CLI::App& add_bench_command(CLI::App& program, int& exit_status);

// One subcommand each.
void add_bench_reconstruct_command(CLI::App& bench, int& exit_status);
void add_bench_display_command(CLI::App& bench, int& exit_status);
void add_bench_chain_command(CLI::App& bench, int& exit_status);

} // namespace octascope::firmware_host
