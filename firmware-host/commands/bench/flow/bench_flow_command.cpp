#include <memory>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <unistd.h>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/bench/flow/bench_flow.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/numbers.h"
#include "firmware-host/terminal/terminal.h"
#include "pipeline/angiography/b_scan_flow.h"

namespace octascope::firmware_host {

namespace {

struct BenchFlowArguments {
  bool as_json = false;
  int repeats = 0; // 0: all of FlowBenchOptions
  int b_scans = FlowBenchOptions{}.b_scans;
};

int run(const BenchFlowArguments& arguments, const FlowProbe& probe) {
  FlowBenchOptions options;
  options.b_scans = arguments.b_scans;
  if (arguments.repeats > 0)
    options.repeats = {arguments.repeats};
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  const auto progress = [&](const std::string& words) {
    if (terminal)
      show_progress(words);
  };
  const auto report = bench_flow(options, probe, progress);
  progress("");
  if (!report)
    return complain("bench flow", report.error());
  say("{}{}", arguments.as_json ? to_json(*report) : to_text(*report),
      arguments.as_json ? "\n" : "");
  return exit_done;
}

} // namespace

void add_bench_flow_command(CLI::App& bench, int& exit_status, FlowProbe probe) {
  auto arguments = std::make_shared<BenchFlowArguments>();
  CLI::App* command = bench.add_subcommand(
      "flow", "How well flow and vessels found in simulated spectra agree with "
              "the truth");
  command->add_flag("--json", arguments->as_json, "One JSON object");
  command
      ->add_option("--repeats", arguments->repeats,
                   "Sweeps of each B-scan (2 and then 4 if not given)")
      ->check(within(pipeline::BScanFlow::fewest_repeats, pipeline::BScanFlow::most_repeats));
  command
      ->add_option("--b-scans", arguments->b_scans,
                   fmt::format("The middle ones of the phantom's ({} if not given: all)",
                               arguments->b_scans))
      ->check(within(1, arguments->b_scans));
  command->footer("Figures of the flow volume and of the tree traced in it, and of a run of ten "
                  "seconds on\nthe simulated devices: at 215 kHz, with 4 repeats at 860 kHz.\n"
                  "Example: octascope bench flow --repeats 2 --json");
  command->callback([arguments, probe = std::move(probe), &exit_status] {
    exit_status = run(*arguments, probe);
  });
}

} // namespace octascope::firmware_host
