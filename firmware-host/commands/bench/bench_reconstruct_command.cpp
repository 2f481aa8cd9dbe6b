#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "firmware-host/commands/bench/bench_command.h"
#include "firmware-host/commands/bench/bench_reconstruct.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/numbers.h"
#include "firmware-host/terminal/terminal.h"

namespace octascope::firmware_host {

void add_bench_reconstruct_command(CLI::App& bench, int& exit_status) {
  struct Options {
    bool as_json = false;
    double seconds = 30;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = bench.add_subcommand(
      "reconstruct", "Lines a second of each path, relative to bare FFTW transforms");
  command->add_flag("--json", options->as_json, "One JSON object");
  command->add_option("--seconds", options->seconds, "About how long to measure (30 if not given)")
      ->check(within(0.1, 3600.0));
  command->footer("Example: octascope bench reconstruct --json");
  command->callback([options, &exit_status] {
    const auto report = bench_reconstruct(options->seconds);
    if (!report) {
      warn("octascope bench reconstruct: {}\n", report.error().message);
      exit_status = exit_failed;
      return;
    }
    if (options->as_json)
      say("{}\n", to_json(*report));
    else
      say("{}", to_text(*report));
    exit_status = exit_done;
  });
}

} // namespace octascope::firmware_host
