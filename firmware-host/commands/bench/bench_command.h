// octascope bench: how fast this machine does it.
#pragma once

#include <CLI/App.hpp>

namespace octascope::firmware_host {

// Adds "bench" with its subcommands, and returns it for those of other rooms; see add_run_command()
// for `exit_status`.
CLI::App& add_bench_command(CLI::App& program, int& exit_status);

// One subcommand each.
void add_bench_reconstruct_command(CLI::App& bench, int& exit_status);
void add_bench_display_command(CLI::App& bench, int& exit_status);

} // namespace octascope::firmware_host
