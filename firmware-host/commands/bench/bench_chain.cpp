#include "firmware-host/commands/bench/bench_chain.h"

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <string_view>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "firmware-host/commands/bench/bench_timing.h"
#include "firmware-host/commands/bench/rate_search.h"
#include "firmware-host/commands/bench/self_run.h"
#include "firmware-host/commands/bench/undisplayed_chain.h"
#include "firmware-host/reconstruction/reconstruction_cache.h"
#include "firmware-host/report/report_parts.h"

namespace octascope::firmware_host {

namespace {

constexpr std::array formats{ChainFormat{1024, 300, 80}, ChainFormat{1024, 512, 128},
                             ChainFormat{2048, 300, 80}, ChainFormat{2048, 512, 128}};
constexpr std::array given_rates_hz{215e3, 430e3, 860e3};
constexpr double displayed_runs = 80; // what the time is divided by: each starts a program
constexpr double undisplayed_runs = 160;
constexpr double given_runs = 24;
constexpr double shortest_run_s = 1.5;  // a display needs a part of it to open
constexpr double fewest_volumes = 6;    // that a run is long enough for
constexpr double fly_back_share = 0.26; // of the kept lines

// Jiffies of all processors since the machine started.
struct ProcessorTime {
  double all = 0;
  double stolen = 0;

  static ProcessorTime now() {
    std::ifstream stat{"/proc/stat"};
    std::string word;
    stat >> word;
    ProcessorTime time;
    double jiffies = 0;
    for (int column = 0; column < 8 && stat >> jiffies; ++column) { // user … steal
      time.all += jiffies;
      time.stolen = jiffies;
    }
    return time;
  }
};

class Chain {
public:
  Chain(BenchFolder folder, const ChainConditions& conditions)
      : folder_{std::move(folder)}, conditions_{conditions} {}

  hal::Result<ChainFigures> measure(const ChainCase& what, double shortest_s) {
    const std::filesystem::path file = folder_.file("chain.toml");
    write_configuration(file, what);
    const double run_s = std::max(shortest_s, fewest_volumes / planned_per_s(what));
    const ProcessorTime before = ProcessorTime::now();
    HAL_TRY(ChainFigures figures, what.display ? displayed(file, run_s) : undisplayed(file, run_s));
    const ProcessorTime after = ProcessorTime::now();
    figures.stolen = (after.stolen - before.stolen) / std::max(after.all - before.all, 1.0);
    return figures;
  }

  // Two of three runs without a loss: the figures of the second. Else empty.
  hal::Result<std::optional<ChainFigures>> hold(const ChainCase& what) {
    const double run_s = what.display ? conditions_.displayed_run_s : conditions_.undisplayed_run_s;
    int held = 0;
    int lost = 0;
    while (lost < 2) {
      HAL_TRY(const ChainFigures figures, measure(what, run_s));
      // Neither a chain that was not fed nor one that showed nothing has held.
      const bool came = figures.volumes_per_s >= planned_per_s(what) / 2;
      const bool shown = !what.display || figures.quality.frames > 0;
      if (figures.lost_lines > 0 || !came || !shown)
        ++lost;
      else if (++held == 2)
        return figures;
    }
    return std::nullopt;
  }

private:
  static double planned_per_s(const ChainCase& what) {
    const double lines = (1 + fly_back_share) * what.format.a_scans * what.format.b_scans;
    return what.line_rate_hz / lines;
  }

  static void write_configuration(const std::filesystem::path& file, const ChainCase& what) {
    std::ofstream{file} << fmt::format(
        "[scan]\nsamples = {}\na_scans = {}\nfly_back_lines = {:.0f}\nb_scans = {}\n"
        "line_rate_hz = {:.0f}\n[display]\nrolling = {}\n",
        what.format.samples, what.format.a_scans, fly_back_share * what.format.a_scans,
        what.format.b_scans, what.line_rate_hz, what.rolling);
  }

  hal::Result<ChainFigures> displayed(const std::filesystem::path& configuration, double run_s) {
    HAL_TRY(const auto report,
            report_of({"run", "--sim", "--config", configuration.string(), "--display", "offscreen",
                       "--size", fmt::format("{}x{}", conditions_.size[0], conditions_.size[1]),
                       "--duration", fmt::format("{}", run_s)},
                      folder_.file("report.json")));
    const auto number = [&](const char* pointer) { return number_in(report, pointer); };
    const auto latency = [&](const std::string& key) -> std::optional<ChainLatency> {
      if (number("/volumes/displayed") == 0)
        return std::nullopt;
      const auto at = [&](const char* share) { return number((key + share).c_str()); };
      return ChainLatency{at("/p50"), at("/p95"), at("/p99")};
    };
    return ChainFigures{.lost_lines = static_cast<std::uint64_t>(number("/lost/lines")),
                        .volumes_per_s = number("/rates/volumes_per_s"),
                        .passed_over_per_s = number("/volumes/passed_over") / number("/duration_s"),
                        .shown_per_s = number("/rates/shown_volumes_per_s"),
                        .frames_per_s = number("/rates/frames_per_s"),
                        .latency = latency("/latency_ms"),
                        .line_latency = latency("/line_latency_ms"),
                        .quality = quality_in(report)};
  }

  hal::Result<ChainFigures> undisplayed(const std::filesystem::path& file, double run_s) {
    HAL_TRY(const Configuration configuration, load_configuration(file));
    HAL_TRY(const pipeline::VolumeCounters counters, run_undisplayed(configuration, run_s));
    return ChainFigures{.lost_lines = counters.lost_lines,
                        .volumes_per_s = static_cast<double>(counters.acquired) / run_s};
  }

  BenchFolder folder_;
  ChainConditions conditions_;
};

class Bench {
public:
  Bench(Chain chain, const ChainOptions& options,
        const std::function<void(const ChainResult&)>& tell)
      : chain_{std::move(chain)}, seconds_{options.seconds}, tell_{tell} {
    report_.conditions = conditions_of(options);
  }

  // The given rates first: they are sure to be told.
  hal::Result<ChainReport> run() && {
    for (const ChainFormat& format : formats)
      for (const bool rolling : {false, true})
        for (const double given_hz : given_rates_hz)
          HAL_CHECK(measure_given({format, true, given_hz, rolling},
                                  &format == formats.data() ? report_.conditions.given_run_s
                                                            : report_.conditions.displayed_run_s));
    int searches_left = searches;
    for (const ChainFormat& format : formats) {
      // A display only takes time from the rest: what does not hold without one holds with none.
      SearchRange range{.start = first_rung(format)};
      for (const auto& [display, rolling] : ways) {
        const double spent_s = seconds_since(began_);
        until_s_ = spent_s + (seconds_ - spent_s) / searches_left;
        --searches_left;
        HAL_TRY(const FoundRate found, search({format, display, 0, rolling}, range));
        range.start = found.rung >= 0 ? found.rung : range.start - 4;
        if (!display && found.complete)
          range.rungs = std::max(found.rung + 1, 1);
      }
    }
    return std::move(report_);
  }

private:
  struct Way {
    bool display, rolling;
  };
  static constexpr std::array ways{Way{false, false}, Way{true, false}, Way{true, true}};
  static constexpr int searches{ways.size() * formats.size()};

  // 800 kHz; lines of twice the length cost twice as much.
  static int first_rung(const ChainFormat& format) { return format.samples > 1024 ? 8 : 12; }

  hal::Result<> measure_given(const ChainCase& what, double run_s) {
    if (seconds_since(began_) >= seconds_)
      return {};
    HAL_TRY(const ChainFigures figures, chain_.measure(what, run_s));
    add({what, figures, RateSign::given});
    return {};
  }

  // As long as its share of the time lasts. The rate of `what` is what is looked for.
  hal::Result<FoundRate> search(ChainCase what, const SearchRange& range) {
    ChainFigures at_highest;
    const auto holds = [&](int rung) -> hal::Result<bool> {
      what.line_rate_hz = rate_hz(rung);
      HAL_TRY(const auto held, chain_.hold(what));
      at_highest = held.value_or(at_highest);
      return held.has_value();
    };
    HAL_TRY(const FoundRate found,
            highest_rung(range, holds, [&] { return seconds_since(began_) < until_s_; }));
    if (found.rung < 0)
      return found;
    what.line_rate_hz = rate_hz(found.rung);
    double& best = what.display ? report_.with_display_hz : report_.reconstruct_only_hz;
    best = std::max(best, what.line_rate_hz);
    add({what, at_highest, found.complete ? RateSign::highest : RateSign::held});
    return found;
  }

  void add(const ChainResult& result) {
    report_.cases.push_back(result);
    tell_(result);
  }

  Chain chain_;
  BenchClock::time_point began_ = BenchClock::now();
  double seconds_;
  double until_s_ = 0; // the present search
  const std::function<void(const ChainResult&)>& tell_;
  ChainReport report_;
};

std::string_view name_of(RateSign sign) {
  switch (sign) {
  case RateSign::highest: return "highest";
  case RateSign::held: return "held";
  case RateSign::given: return "given";
  }
  return "";
}

nlohmann::ordered_json json_of(const ChainResult& result) {
  const auto& [what, figures, sign] = result;
  nlohmann::ordered_json json{{"samples", what.format.samples},
                              {"a_scans", what.format.a_scans},
                              {"b_scans", what.format.b_scans},
                              {"mode", what.rolling ? "rolling" : "whole"},
                              {"display", what.display},
                              {"line_rate_hz", what.line_rate_hz},
                              {"rate", name_of(sign)},
                              {"lost_lines", figures.lost_lines},
                              {"volumes_per_s", figures.volumes_per_s}};
  if (what.display) {
    json["passed_over_per_s"] = figures.passed_over_per_s;
    json["shown_per_s"] = figures.shown_per_s;
    json["frames_per_s"] = figures.frames_per_s;
    json["quality"] = to_json(figures.quality);
  }
  const auto add = [&](const char* key, const std::optional<ChainLatency>& latency) {
    json[key] = nullptr;
    if (latency)
      json[key] = {{"p50", latency->p50_ms}, {"p95", latency->p95_ms}, {"p99", latency->p99_ms}};
  };
  if (what.display) {
    add("latency_ms", figures.latency);
    add("line_latency_ms", figures.line_latency);
  }
  json["stolen"] = figures.stolen;
  return json;
}

} // namespace

ChainConditions conditions_of(const ChainOptions& options) {
  return {.cpu = processor_name(),
          .cores = static_cast<int>(std::thread::hardware_concurrency()),
          .size = options.size,
          .displayed_run_s = std::max(options.seconds / displayed_runs, shortest_run_s),
          .given_run_s = std::max(options.seconds / given_runs, shortest_run_s),
          .undisplayed_run_s = std::max(options.seconds / undisplayed_runs, shortest_run_s)};
}

hal::Result<ChainReport> bench_chain(const ChainOptions& options,
                                     const std::function<void(const ChainResult&)>& tell) {
  HAL_TRY(auto folder, BenchFolder::make());
  return Bench{Chain{std::move(folder), conditions_of(options)}, options, tell}.run();
}

std::string to_json(const ChainReport& report) {
  const ChainConditions& conditions = report.conditions;
  nlohmann::ordered_json json{
      {"cpu", conditions.cpu},
      {"cores", conditions.cores},
      {"display", fmt::format("offscreen, {}x{}", conditions.size[0], conditions.size[1])},
      {"run_s",
       {{"with_display", conditions.displayed_run_s},
        {"at_given_rates", conditions.given_run_s},
        {"without", conditions.undisplayed_run_s}}},
      {"cases", nlohmann::ordered_json::array()},
      {"highest_line_rate_hz",
       {{"reconstruct_only", report.reconstruct_only_hz},
        {"with_display", report.with_display_hz}}}};
  for (const ChainResult& result : report.cases)
    json["cases"].push_back(json_of(result));
  return json.dump(2);
}

} // namespace octascope::firmware_host
