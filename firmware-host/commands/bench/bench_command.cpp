#include "firmware-host/commands/bench/bench_command.h"

#include "firmware-host/commands/bench/flow/bench_flow.h"
#include "firmware-host/commands/bench/live_probe.h"
#include "firmware-host/commands/bench/registration/bench_registration_command.h"

namespace octascope::firmware_host {

CLI::App& add_bench_command(CLI::App& program, int& exit_status) {
  CLI::App* bench = program.add_subcommand("bench", "How fast this machine does it, and how well");
  bench->require_subcommand(1);
  bench->footer("Example: octascope bench display --json");
  add_bench_reconstruct_command(*bench, exit_status);
  add_bench_display_command(*bench, exit_status);
  add_bench_chain_command(*bench, exit_status);
  add_bench_flow_command(*bench, exit_status, probe_flow);
  add_bench_registration_command(*bench, exit_status);
  return *bench;
}

} // namespace octascope::firmware_host
