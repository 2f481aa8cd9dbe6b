// The appliance on its twins for minutes or hours: first undisturbed, then under random faults.
// Exit status 0: nothing leaked, nothing was lost that the faults do not explain; 1: something was;
// 2: wrong use.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "pipeline/scan/scan_plan.h"
#include "tests/soak/cpu_hog.h"
#include "tests/soak/soak_verdict.h"
#include "tests/soak/stolen_time.h"
#include "tests/support/devices/random_faults.h"
#include "tests/support/files/scratch_folder.h"
#include "tests/support/program/program_run.h"

namespace octascope::tests {
namespace {

struct SoakOptions {
  double minutes = 3;
  unsigned seed = std::random_device{}() % 1000000;
  double line_rate_hz = 215000;
  int samples = 1024, a_scans = 300, fly_back = 79, b_scans = 80;
  double steal_ms = 0;
  std::string size = "1280x720";
  std::string keep; // a folder for scripts, reports and samples
};

constexpr double sample_every_s = 0.25;

struct Phase {
  std::string name;
  double seconds = 0;
  SoakTimes times{};
  std::string faults = {}; // a script; empty: none
  double explained = 0;
};

struct Outcome {
  Phase phase;
  Held settled = {}, final = {};
  double stolen_s = 0; // of the processors' time, by the host of a virtual machine
  nlohmann::json report = nlohmann::json::object();
  std::vector<std::string> complaints = {};
};

pipeline::ScanPlan plan_of(const SoakOptions& options) {
  pipeline::ScanPlan plan;
  plan.samples = options.samples;
  plan.a_scans = options.a_scans;
  plan.fly_back_lines = options.fly_back;
  plan.b_scans = options.b_scans;
  plan.line_rate_hz = options.line_rate_hz;
  return plan;
}

// A switch that sticks must not choose another technique or layout: what these keep for themselves
// is memory that grows, and no leak.
constexpr const char* controls_file = "soak-controls.toml";
constexpr const char* controls =
    "name = \"Soak\"\n"
    "[[bind]]\nswitch = \"left\"\ngesture = \"press\"\naction = \"box\"\n"
    "[[bind]]\nswitch = \"centre\"\ngesture = \"press\"\naction = \"freeze\"\n"
    "[[bind]]\nswitch = \"right\"\ngesture = \"press\"\naction = \"legend\"\n";

std::string configuration(const SoakOptions& options) {
  return fmt::format("[scan]\nsamples = {}\na_scans = {}\nfly_back_lines = {}\nb_scans = {}\n"
                     "line_rate_hz = {}\n[sim]\nloop_volumes = 2\n[controls]\nfile = \"{}\"\n",
                     options.samples, options.a_scans, options.fly_back, options.b_scans,
                     options.line_rate_hz, controls_file);
}

// A third of the time, at least enough to look twice.
Phase quiet_phase(const SoakOptions& options) {
  const double seconds = std::max(30.0, options.minutes * 20);
  const double look_s = std::clamp(seconds / 6, 5.0, 60.0);
  return {.name = "quiet", .seconds = seconds, .times = {15, 15 + look_s, seconds - look_s}};
}

// Each fault once belongs to the warm-up: what is made when a device first comes back is kept.
Phase faulty_phase(const SoakOptions& options) {
  const Rehearsal rehearsal = every_fault_once(options.seed, 12);
  const double settled_from_s = rehearsal.until_s + 5;
  const double seconds = std::max(settled_from_s + 40, options.minutes * 40);
  const double look_s = std::clamp((seconds - settled_from_s) / 6, 5.0, 60.0);
  const SoakTimes times{settled_from_s, settled_from_s + look_s, seconds - look_s};
  const std::string script = rehearsal.script + random_faults(options.seed, times.settled_until_s,
                                                              times.final_from_s - 5, 1.5);
  const auto read = sim::FaultScript::parse(script, "random faults");
  if (!read)
    throw std::runtime_error{read.error().message};
  const double explained = most_volumes_lost(*read, plan_of(options).tick_period());
  return {.name = fmt::format("{} faults", read->faults.size()),
          .seconds = seconds,
          .times = times,
          .faults = script,
          .explained = explained};
}

double seconds_since(WallClock::time_point begin) {
  return std::chrono::duration<double>(WallClock::now() - begin).count();
}

std::vector<ProcessSample> watch(const ProgramRun& run, WallClock::time_point begin) {
  std::vector<ProcessSample> samples;
  for (int i = 1; run.running(); ++i) {
    std::this_thread::sleep_until(begin + std::chrono::duration_cast<WallClock::duration>(
                                              std::chrono::duration<double>(i * sample_every_s)));
    if (auto sample = sample_process(run.process())) {
      sample->at_s = seconds_since(begin);
      samples.push_back(*sample);
    }
  }
  return samples;
}

void keep_samples(const std::filesystem::path& file, const std::vector<ProcessSample>& samples) {
  std::ofstream out{file};
  out << "seconds,resident_kib,descriptors,threads\n";
  for (const ProcessSample& s : samples)
    out << fmt::format("{:.2f},{:.0f},{},{}\n", s.at_s, s.resident_kib, s.descriptors, s.threads);
}

Outcome soak(const SoakOptions& options, const Phase& phase, const std::filesystem::path& folder) {
  const auto file = [&](std::string_view ending) {
    return (folder / fmt::format("{}{}", phase.faults.empty() ? "quiet" : "faulty", ending))
        .string();
  };
  std::ofstream{folder / controls_file} << controls;
  std::ofstream{file(".toml")} << configuration(options);
  std::vector<std::string> words{
      "run",       "--sim",      "--config",   file(".toml"), "--display",
      "offscreen", "--size",     options.size, "--duration",  fmt::format("{:.1f}", phase.seconds),
      "--report",  file(".json")};
  if (!phase.faults.empty()) {
    std::ofstream{file("-faults.toml")} << phase.faults;
    words.insert(words.end(), {"--faults", file("-faults.toml")});
  }
  const double stolen_before_s = stolen_seconds();
  const auto begin = WallClock::now();
  std::optional<CpuHog> hog;
  if (options.steal_ms > 0)
    hog.emplace(std::chrono::duration<double, std::milli>{options.steal_ms}, options.seed);
  ProgramRun run{octascope_command(words)};
  const std::vector<ProcessSample> samples = watch(run, begin);
  const ProgramResult result = run.wait();
  hog.reset();
  keep_samples(file(".csv"), samples);

  Outcome outcome{.phase = phase};
  outcome.stolen_s = stolen_seconds() - stolen_before_s;
  const double last_s = samples.empty() ? 0 : samples.back().at_s;
  outcome.settled = held_between(samples, phase.times.settled_from_s, phase.times.settled_until_s);
  outcome.final = held_between(samples, phase.times.final_from_s, std::min(last_s, phase.seconds));
  outcome.complaints = complaints_about_growth(outcome.settled, outcome.final);
  if (result.exit_status != 0)
    outcome.complaints.push_back(result.describe());
  std::ifstream in{file(".json")};
  const auto report = nlohmann::json::parse(in, nullptr, false);
  if (report.is_object()) {
    outcome.report = report;
    for (std::string& words_said : complaints_about_volumes(report, phase.explained))
      outcome.complaints.push_back(std::move(words_said));
  } else {
    outcome.complaints.emplace_back("no report was written");
  }
  return outcome;
}

void print_complaints(const Outcome& outcome) {
  for (const std::string& complaint : outcome.complaints)
    fmt::print("FAILED, {}: {}\n", outcome.phase.name, complaint);
  if (!outcome.complaints.empty() && outcome.stolen_s > 0)
    fmt::print("meanwhile the host kept the processors from this machine for {:.1f} s\n",
               outcome.stolen_s);
  std::fflush(stdout);
}

// In a short soak one late event weighs much: others on the machine take a volume's time, or have
// the governor draw coarser for the first time, and the shaders for that are made then. A short
// soak has three tries; a leak, or a loss of the program's own making, is in each.
Outcome soak_in_tries(const SoakOptions& options, const Phase& phase,
                      const std::filesystem::path& folder) {
  const int tries = options.minutes <= 5 ? 3 : 1;
  for (int i = 1;; ++i) {
    Outcome outcome = soak(options, phase, folder);
    if (outcome.complaints.empty() || i == tries)
      return outcome;
    print_complaints(outcome);
    fmt::print("once more, the {} of {} tries\n", i + 1 == tries ? "last" : "second", tries);
  }
}

void print_row(std::string_view what, std::string_view quiet, std::string_view faulty) {
  fmt::print("{:<34}{:>16}{:>16}\n", what, quiet, faulty);
}

std::string figure(const Outcome& outcome, const char* group, const char* key) {
  const auto found = outcome.report.find(group);
  return found == outcome.report.end() ? "-" : found->at(key).dump();
}

void print_table(const Outcome& quiet, const Outcome& faulty) {
  const auto row = [&](std::string_view what, auto&& of) {
    print_row(what, of(quiet), of(faulty));
  };
  const auto counted = [&](std::string_view what, const char* group, const char* key) {
    row(what, [&](const Outcome& o) { return figure(o, group, key); });
  };
  print_row("", quiet.phase.name, faulty.phase.name);
  row("seconds", [](const Outcome& o) { return fmt::format("{:.0f}", o.phase.seconds); });
  counted("lines per second", "rates", "lines_per_s");
  counted("volumes planned", "volumes", "planned");
  counted("  acquired", "volumes", "acquired");
  counted("    displayed", "volumes", "displayed");
  counted("    skipped", "volumes", "skipped");
  counted("    lost on the way to the glass", "volumes", "lost");
  counted("  passed over", "volumes", "passed_over");
  counted("  lost (nothing came)", "lost", "volumes");
  row("    explained by faults, at most",
      [](const Outcome& o) { return fmt::format("{:.0f}", o.phase.explained); });
  counted("  unfinished at the end", "volumes", "unfinished");
  counted("B-scans lost", "lost", "b_scans");
  counted("allocations in hot paths", "hot_path", "allocations");
  row("s of processors the host kept",
      [](const Outcome& o) { return fmt::format("{:.1f}", o.stolen_s); });
  row("resident KiB, settled",
      [](const Outcome& o) { return fmt::format("{:.0f}", o.settled.resident_kib); });
  row("resident KiB, at the end",
      [](const Outcome& o) { return fmt::format("{:.0f}", o.final.resident_kib); });
  row("  grown, per cent", [](const Outcome& o) {
    return fmt::format("{:+.3f}", 100 * (o.final.resident_kib / o.settled.resident_kib - 1));
  });
  row("descriptors", [](const Outcome& o) {
    return fmt::format("{} > {}", o.settled.descriptors, o.final.descriptors);
  });
  row("threads",
      [](const Outcome& o) { return fmt::format("{} > {}", o.settled.threads, o.final.threads); });
}

int soak(const SoakOptions& options) {
  const pipeline::ScanPlan plan = plan_of(options);
  if (const auto valid = plan.validate(); !valid) {
    fmt::print(stderr, "soak: {}\n", valid.error().message);
    return 2;
  }
  if (options.steal_ms > 0 && !CpuHog::is_permitted()) {
    fmt::print(stderr, "soak: --steal needs real-time priority, which this user may not have: "
                       "start it as root\n");
    return 2;
  }
  const Phase quiet = quiet_phase(options);
  const Phase faulty = faulty_phase(options);
  fmt::print("soak: --seed {} --minutes {} --rate {}: {:.0f} s undisturbed, {:.0f} s with {}\n",
             options.seed, options.minutes, options.line_rate_hz, quiet.seconds, faulty.seconds,
             faulty.name);
  std::fflush(stdout);
  const ScratchFolder scratch;
  const std::filesystem::path folder =
      options.keep.empty() ? scratch.path() : std::filesystem::path{options.keep};
  std::filesystem::create_directories(folder);
  const Outcome first = soak_in_tries(options, quiet, folder);
  const Outcome second = soak_in_tries(options, faulty, folder);
  print_table(first, second);
  print_complaints(first);
  print_complaints(second);
  const bool passed = first.complaints.empty() && second.complaints.empty();
  fmt::print("soak: {}, seed {}\n", passed ? "passed" : "FAILED", options.seed);
  return passed ? 0 : 1;
}

} // namespace
} // namespace octascope::tests

int main(int argc, char** argv) {
  octascope::tests::SoakOptions options;
  CLI::App app{
      "The appliance on its twins for minutes or hours, undisturbed and under random faults"};
  app.add_option("--minutes", options.minutes, "In all; a third of them undisturbed")
      ->check(CLI::Range(0.1, 10000.0))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "Of the faults; else drawn and printed");
  app.add_option("--rate", options.line_rate_hz, "Lines per second")->capture_default_str();
  app.add_option("--samples", options.samples, "Samples per line")->capture_default_str();
  app.add_option("--a-scans", options.a_scans, "Kept lines of a sweep")->capture_default_str();
  app.add_option("--fly-back", options.fly_back, "Other lines of a sweep")->capture_default_str();
  app.add_option("--b-scans", options.b_scans, "B-scans of a volume")->capture_default_str();
  app.add_option("--steal", options.steal_ms,
                 "Milliseconds for which all processors are taken away, about once a second")
      ->check(CLI::Range(0.0, 500.0));
  app.add_option("--size", options.size, "Of the picture")->capture_default_str();
  app.add_option("--keep", options.keep, "Keep scripts, reports and samples in this folder");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return octascope::tests::soak(options);
}
