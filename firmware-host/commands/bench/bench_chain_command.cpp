#include <memory>
#include <optional>
#include <string>
#include <string_view>

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

constexpr char columns[] =
    "{:<16}  {:<7} {:>6}{:1} {:>8} {:>6} {:>6} {:>7}  {:>5} {:>5} {:>5}  {:>10}  {:>8} {:>7}\n";

void print_head(const ChainConditions& c) {
  say("{}, {} cores; picture {}x{}, offscreen at 60 Hz; the view rests. Runs of {:.1f} s, start\n"
      "included; of the first scan at given rates of {:.1f} s; without a display of {:.1f} s.\n"
      "*: the highest rate at which two of three runs lost nothing; +: the time was over before a\n"
      "higher one was tried. Volumes acquired and shown, and frames, a second. Latency in ms:\n"
      "whole, from a volume's last line; rolling, from any line. Quality of the volume's picture,\n"
      "median and worst frame: share of full resolution, steps along the longest edge.\n\n",
      c.cpu, c.cores, c.size[0], c.size[1], c.displayed_run_s, c.given_run_s, c.undisplayed_run_s);
  say(columns, "samples, scan", "display", "kHz", "", "lost", "acq.", "shown", "frames", "p50",
      "p95", "p99", "resolution", "steps", "stolen");
}

std::string text_of(const std::optional<QualityRange>& range, int digits) {
  return range ? fmt::format("{:.{}f} {:.{}f}", range->median, digits, range->worst, digits)
               : std::string{"-"};
}

std::string_view words_for(const ChainCase& what) {
  return what.rolling ? "rolling" : what.display ? "whole" : "none";
}

std::string_view mark_of(RateSign sign) {
  switch (sign) {
  case RateSign::highest: return "*";
  case RateSign::held: return "+";
  case RateSign::given: return "";
  }
  return "";
}

void print_line(const ChainResult& result) {
  const auto& [what, figures, sign] = result;
  const auto rounded_to = [](double value, int digits) {
    return fmt::format("{:.{}f}", value, digits);
  };
  const auto shown = [&](double value) {
    return what.display ? rounded_to(value, 1) : std::string{"-"};
  };
  const auto& latency = what.rolling ? figures.line_latency : figures.latency;
  const auto latency_text = [&](double ChainLatency::*share) {
    return latency ? rounded_to((*latency).*share, 0) : std::string{"-"};
  };
  say(columns,
      fmt::format("{:>4} x {:>3} x {:>3}", what.format.samples, what.format.a_scans,
                  what.format.b_scans),
      words_for(what), rounded_to(what.line_rate_hz * 1e-3, 0), mark_of(sign), figures.lost_lines,
      rounded_to(figures.volumes_per_s, 1), shown(figures.shown_per_s), shown(figures.frames_per_s),
      latency_text(&ChainLatency::p50_ms), latency_text(&ChainLatency::p95_ms),
      latency_text(&ChainLatency::p99_ms), text_of(figures.quality.resolution, 2),
      text_of(figures.quality.steps, 0), rounded_to(figures.stolen * 100, 1) + " %");
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
    print_head(conditions_of(options));
  const auto report = bench_chain(options, [&](const ChainResult& result) {
    if (!arguments.as_json)
      print_line(result);
  });
  if (!report)
    return complain("bench chain", report.error());
  if (arguments.as_json)
    say("{}\n", to_json(*report));
  else
    say("\nhighest: {:.0f} kHz without a display, {:.0f} kHz with one\n",
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
