// The subcommands of the program. Each adds itself to the command line and, when called, stores its
// exit status: 0 done, 1 failed, 2 wrong use.
#pragma once

#include <CLI/App.hpp>

namespace octascope::firmware_host {

inline constexpr int exit_done = 0;
inline constexpr int exit_failed = 1;
inline constexpr int exit_wrong_use = 2;

void add_run_command(CLI::App& program, int& exit_status);
void add_record_command(CLI::App& program, int& exit_status);
void add_capture_command(CLI::App& program, int& exit_status);
void add_replay_command(CLI::App& program, int& exit_status);
void add_devices_command(CLI::App& program, int& exit_status);
void add_doctor_command(CLI::App& program, int& exit_status);

} // namespace octascope::firmware_host
