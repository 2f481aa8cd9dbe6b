#include "firmware-host/commands/bench/registration/bench_registration_command.h"

#include <cmath>
#include <memory>
#include <span>
#include <string>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/bench/registration/registration_trials.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/numbers.h"
#include "firmware-host/terminal/terminal.h"

namespace octascope::firmware_host {

namespace {

struct BenchRegistrationArguments {
  bool as_json = false;
  int trials = TrialOptions{}.trials;
};

std::string registration_text(std::span<const TrialFigures> all) {
  std::string text =
      "trees that are there:      trials  found  misplaced  off by at most  turned by  "
      "overlap    lead  processor time\n";
  for (const TrialFigures& f : all)
    if (f.same)
      text += fmt::format(
          "  {:<24} {:>6} {:>6} {:>10} {:>12.0f} µm {:>8.2f}°  {:.2f}–{:.2f}  {:.2f} "
          "{:>12.2f} s\n",
          f.kind, f.trials, f.right, f.misplaced, f.largest_off_mm * 1e3, f.largest_turn_deg,
          f.least_overlap, f.most_overlap, f.least_lead, f.longest_s);
  text += "trees that are not there:  trials  refused  accepted  overlap    processor time\n";
  for (const TrialFigures& f : all)
    if (!f.same)
      text +=
          fmt::format("  {:<24} {:>6} {:>8} {:>9}  {:.2f}–{:.2f} {:>12.2f} s\n", f.kind, f.trials,
                      f.right, f.misplaced, f.least_overlap, f.most_overlap, f.longest_s);
  return text;
}

std::string registration_json(std::span<const TrialFigures> all) {
  auto json = nlohmann::ordered_json::array();
  const auto rounded = [](double value) { return std::round(value * 1e4) / 1e4; };
  for (const TrialFigures& f : all)
    json.push_back({{"kind", f.kind},
                    {"there", f.same},
                    {"trials", f.trials},
                    {"right", f.right},
                    {"misplaced", f.misplaced},
                    {"overlap", {rounded(f.least_overlap), rounded(f.most_overlap)}},
                    {"least_lead", rounded(f.least_lead)},
                    {"off_mm", rounded(f.largest_off_mm)},
                    {"turned_deg", rounded(f.largest_turn_deg)},
                    {"longest_s", rounded(f.longest_s)}});
  return json.dump(2) + "\n";
}

int run(const BenchRegistrationArguments& arguments) {
  const bool terminal = ::isatty(STDERR_FILENO) != 0;
  const auto progress = [&](const std::string& words) {
    if (terminal)
      show_progress(words);
  };
  const auto all = registration_trials({.trials = arguments.trials}, progress);
  progress("");
  if (!all)
    return complain("bench registration", all.error());
  say("{}", arguments.as_json ? registration_json(*all) : registration_text(*all));
  return exit_done;
}

} // namespace

void add_bench_registration_command(CLI::App& bench, int& exit_status) {
  constexpr int most_trials = 10000;
  auto arguments = std::make_shared<BenchRegistrationArguments>();
  CLI::App* command = bench.add_subcommand(
      "registration",
      "How surely a vessel tree is found again where it moved, and another refused");
  command->add_flag("--json", arguments->as_json,
                    "One JSON array, an object for each kind of trial");
  command
      ->add_option("--trials", arguments->trials,
                   fmt::format("Of trees that are there, and as many of others ({} if not given)",
                               arguments->trials))
      ->check(within(1, most_trials));
  command->footer(
      "Turns of up to 20 degrees and shifts of up to a third of the field, of simulated "
      "trees.\n"
      "Example: octascope bench registration --trials 20 --json");
  command->callback([arguments, &exit_status] { exit_status = run(*arguments); });
}

} // namespace octascope::firmware_host
