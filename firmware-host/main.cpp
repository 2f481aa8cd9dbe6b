// octascope: the command line.
#include <string>

#include "firmware-host/commands/bench/bench_command.h"
#include "firmware-host/commands/calibrate/calibrate.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/commission/commission.h"
#include "firmware-host/commands/devices/status.h"
#include "firmware-host/commands/option_guard.h"
#include "firmware-host/commands/recordings/export.h"
#include "firmware-host/commands/recordings/info.h"
#include "firmware-host/commands/vessels/vessels.h"
#include "firmware-host/commands/volume/reconstruct.h"
#include "firmware-host/commands/volume/render.h"
#include "firmware-host/terminal/terminal.h"
#include "firmware-host/version/version.h"
#include "hal/plain_text.h"

namespace {

namespace hal = octascope::hal;
namespace host = octascope::firmware_host;

// Asking for help is not an error; everything else that ends the parsing is wrong use.
int parse(CLI::App& program, int argc, char** argv, int& exit_status) {
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? host::exit_done : host::exit_wrong_use;
  }
  return exit_status;
}

} // namespace

int main(int argc, char** argv) {
  host::prepare_standard_streams();

  CLI::App program{"octascope: OCT volumes through a surgical microscope, live.\n"
                   "Not a medical device."};
  program.set_version_flag("--version", std::string{host::version()});
  program.require_subcommand(1);
  program.footer("Example: octascope run --sim --duration 20\n"
                 "Each command explains itself: octascope run --help");

  program.failure_message([](const CLI::App*, const CLI::Error& error) {
    return "octascope: " + hal::printable(error.what()) + "; octascope --help says how\n";
  });

  int exit_status = host::exit_done;
  host::add_run_command(program, exit_status);
  host::add_record_command(program, exit_status);
  host::add_capture_command(program, exit_status);
  host::add_commission_command(program, exit_status);
  host::add_devices_command(program, exit_status);
  host::add_doctor_command(program, exit_status);
  host::add_status_command(program, exit_status);
  host::add_reconstruct_command(program, exit_status);
  host::add_render_command(program, exit_status);
  host::add_replay_command(program, exit_status);
  host::add_bench_vessels_command(host::add_bench_command(program, exit_status), exit_status);
  host::add_calibrate_command(program, exit_status);
  host::add_vessels_command(program, exit_status);
  host::add_info_command(program, exit_status);
  host::add_export_command(program, exit_status);

  host::guard_options(program);

  const int status = parse(program, argc, argv, exit_status);
  if (const auto written = host::flush_said(); !written) {
    host::warn("octascope: {}\n", written.error().message);
    return status == host::exit_done ? host::exit_failed : status;
  }
  return status;
}
