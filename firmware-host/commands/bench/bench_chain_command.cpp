#include <memory>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/bench/bench_chain.h"
#include "firmware-host/commands/bench/bench_command.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/numbers.h"
#include "firmware-host/terminal/terminal.h"

namespace octascope::firmware_host {

namespace {

struct BenchChainArguments {
  bool as_json = false;
  double seconds = ChainOptions{}.seconds;
  std::string size;
};

void print_line(const ChainResult& result) {
  const auto& [what, figures, sign] = result;
  std::string shown = "-";
  if (const auto& latency = what.rolling ? figures.line_latency : figures.latency)
    shown = fmt::format("{:>7.1f} {:>9.1f}  {:>4.0f} {:>4.0f} {:>4.0f} ms", figures.shown_per_s,
                        figures.frames_per_s, latency->p50_ms, latency->p95_ms, latency->p99_ms);
  say("{:>4} x {:>3} x {:>3}  {:<8} {:>8.0f}{} {:>9} {:>10.1f} {}  stolen {:.1f} %\n",
      what.format.samples, what.format.a_scans, what.format.b_scans,
      what.rolling   ? "rolling"
      : what.display ? "drawn"
                     : "no",
      what.line_rate_hz * 1e-3,
      sign == RateSign::highest ? "*"
      : sign == RateSign::held  ? "+"
                                : " ",
      figures.lost_lines, figures.volumes_per_s, shown, figures.stolen * 100);
}

int run(const BenchChainArguments& arguments) {
  ChainOptions options;
  options.seconds = arguments.seconds;
  if (!arguments.size.empty()) {
    const auto size = parse_size(arguments.size);
    if (!size)
      return complain("bench chain", size.error());
    options.size = *size;
  }
  if (!arguments.as_json)
    say("*: the highest rate at which two of three runs lost nothing; +: the time was over before "
        "a\n"
        "higher one was tried\n\n"
        "samples, scan    display    kHz   lost lines  volumes/s   shown/s  frames/s  latency p50, "
        "p95, p99\n"
        "(of volumes from their last lines; rolling, of every line)\n");
  const auto report = bench_chain(options, [&](const ChainResult& result) {
    if (!arguments.as_json)
      print_line(result);
  });
  if (!report)
    return complain("bench chain", report.error());
  if (arguments.as_json)
    say("{}\n", to_json(*report));
  else
    say("\n{}\nhighest: {:.0f} kHz without a display, {:.0f} kHz with one\n", report->cpu,
        report->reconstruct_only_hz * 1e-3, report->with_display_hz * 1e-3);
  return exit_done;
}

} // namespace

void add_bench_chain_command(CLI::App& bench, int& exit_status) {
  auto arguments = std::make_shared<BenchChainArguments>();
  CLI::App* command = bench.add_subcommand(
      "chain", "The highest line rate of the whole chain without a loss, on simulated devices");
  command->add_flag("--json", arguments->as_json, "One JSON object");
  command
      ->add_option("--seconds", arguments->seconds,
                   "About how long it runs in all (240 if not given)")
      ->check(within(0.1, 3600.0));
  command->add_option("--size", arguments->size, "Of the picture, as 1280x720 (if not given)")
      ->type_name("WxH");
  command->footer("Example: octascope bench chain --json");
  command->callback([arguments, &exit_status] { exit_status = run(*arguments); });
}

} // namespace octascope::firmware_host
