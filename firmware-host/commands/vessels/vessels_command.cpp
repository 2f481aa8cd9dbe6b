#include "firmware-host/commands/vessels/vessels.h"

namespace octascope::firmware_host {

void add_vessels_command(CLI::App& program, int& exit_status) {
  CLI::App* vessels =
      program.add_subcommand("vessels", "Vessel trees, their files and their pictures");
  vessels->require_subcommand(1);
  vessels->footer("Example: octascope vessels info heart.swc --unit um");
  add_vessels_convert_command(*vessels, exit_status);
  add_vessels_generate_command(*vessels, exit_status);
  add_vessels_info_command(*vessels, exit_status);
  add_vessels_render_command(*vessels, exit_status);
  add_vessels_bench_command(*vessels, exit_status);
  add_vessels_register_command(*vessels, exit_status);
  add_vessels_trace_command(*vessels, exit_status);
}

} // namespace octascope::firmware_host
