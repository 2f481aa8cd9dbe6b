#include "firmware-host/commands/bench/bench_chain.h"

#include <algorithm>
#include <fstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "firmware-host/commands/bench/bench_timing.h"
#include "firmware-host/commands/bench/rate_search.h"
#include "firmware-host/commands/bench/self_run.h"
#include "firmware-host/commands/bench/undisplayed_chain.h"
#include "firmware-host/reconstruction/reconstruction_cache.h"

namespace octascope::firmware_host {

namespace {

constexpr std::array formats{ChainFormat{1024, 300, 80}, ChainFormat{1024, 512, 128},
                             ChainFormat{2048, 300, 80}, ChainFormat{2048, 512, 128}};
constexpr std::array told_rates_hz{215e3, 430e3, 860e3};
constexpr double runs_in_all = 150; // what the time is divided by
constexpr double shortest_run_s = 0.5;
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
  Chain(BenchFolder folder, const ChainOptions& options)
      : folder_{std::move(folder)}, size_{options.size}, run_s_{
                                                             std::max(options.seconds / runs_in_all,
                                                                      shortest_run_s)} {}

  hal::Result<ChainFigures> measure(const ChainCase& what) {
    const std::filesystem::path file = folder_.file("chain.toml");
    write_configuration(file, what);
    const ProcessorTime before = ProcessorTime::now();
    HAL_TRY(ChainFigures figures,
            what.display ? displayed(file, run_s(what)) : undisplayed(file, run_s(what)));
    const ProcessorTime after = ProcessorTime::now();
    figures.stolen = (after.stolen - before.stolen) / std::max(after.all - before.all, 1.0);
    return figures;
  }

  // Two of three runs without a loss.
  hal::Result<bool> holds(const ChainCase& what) {
    int held = 0;
    int lost = 0;
    while (held < 2 && lost < 2) {
      HAL_TRY(const ChainFigures figures, measure(what));
      const bool came = figures.volumes_per_s * run_s(what) >= fewest_volumes / 2;
      ++(figures.lost_lines == 0 && came ? held : lost);
    }
    return held == 2;
  }

private:
  double run_s(const ChainCase& what) const {
    const double lines = (1 + fly_back_share) * what.format.a_scans * what.format.b_scans;
    return std::max(run_s_, fewest_volumes * lines / what.line_rate_hz);
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
                       "--size", fmt::format("{}x{}", size_[0], size_[1]), "--duration",
                       fmt::format("{}", run_s)},
                      folder_.file("report.json")));
    const auto number = [&](const char* pointer) { return number_in(report, pointer); };
    const auto latency = [&](const std::string& key) {
      const auto at = [&](const char* share) { return number((key + share).c_str()); };
      return ChainLatency{at("/p50"), at("/p95"), at("/p99")};
    };
    return ChainFigures{.lost_lines = static_cast<std::uint64_t>(number("/lost/lines")),
                        .volumes_per_s = number("/rates/volumes_per_s"),
                        .shown_per_s = number("/volumes/displayed") / number("/duration_s"),
                        .frames_per_s = number("/rates/frames_per_s"),
                        .latency = latency("/latency_ms"),
                        .line_latency = latency("/line_latency_ms")};
  }

  hal::Result<ChainFigures> undisplayed(const std::filesystem::path& file, double run_s) {
    HAL_TRY(const Configuration configuration, load_configuration(file));
    HAL_TRY(const pipeline::VolumeCounters counters, run_undisplayed(configuration, run_s));
    return ChainFigures{.lost_lines = counters.lost_lines,
                        .volumes_per_s = static_cast<double>(counters.acquired) / run_s};
  }

  BenchFolder folder_;
  std::array<int, 2> size_;
  double run_s_; // at least
};

class Bench {
public:
  Bench(Chain chain, const ChainOptions& options,
        const std::function<void(const ChainResult&)>& tell)
      : chain_{std::move(chain)}, seconds_{options.seconds}, tell_{tell} {
    report_.cpu = processor_name();
    report_.size = options.size;
  }

  hal::Result<ChainReport> run() && {
    int start = first_rung;
    for (const ChainFormat& format : formats)
      for (const auto& [display, rolling] : ways) {
        share_ += 1;
        HAL_TRY(const FoundRate found,
                highest_rung(
                    start,
                    [&](int rung) {
                      return chain_.holds({format, display, rate_hz(rung), rolling});
                    },
                    [&] { return time_is_left(); }));
        start = std::max(found.rung, 0);
        if (found.rung >= 0)
          HAL_CHECK(add({format, display, rate_hz(found.rung), rolling},
                        found.complete ? RateSign::highest : RateSign::held));
        for (const double told : told_rates_hz)
          if (display && time_is_left())
            HAL_CHECK(add({format, display, told, rolling}, RateSign::given));
      }
    return std::move(report_);
  }

private:
  static constexpr int first_rung = 12; // 800 kHz
  struct Way {
    bool display, rolling;
  };
  static constexpr std::array ways{Way{false, false}, Way{true, false}, Way{true, true}};

  // Each search has as much of the time as any other.
  bool time_is_left() const {
    return seconds_since(began_) <
           seconds_ * share_ / static_cast<double>(ways.size() * formats.size());
  }

  hal::Result<> add(const ChainCase& what, RateSign sign) {
    HAL_TRY(const ChainFigures figures, chain_.measure(what));
    report_.cases.push_back({what, figures, sign});
    if (sign != RateSign::given) {
      double& best = what.display ? report_.with_display_hz : report_.reconstruct_only_hz;
      best = std::max(best, what.line_rate_hz);
    }
    tell_(report_.cases.back());
    return {};
  }

  Chain chain_;
  BenchClock::time_point began_ = BenchClock::now();
  double seconds_;
  double share_ = 0; // searches that were begun
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
    json["shown_per_s"] = figures.shown_per_s;
    json["frames_per_s"] = figures.frames_per_s;
  }
  const auto add = [&](const char* key, const std::optional<ChainLatency>& latency) {
    if (latency)
      json[key] = {{"p50", latency->p50_ms}, {"p95", latency->p95_ms}, {"p99", latency->p99_ms}};
  };
  add("latency_ms", figures.latency);
  add("line_latency_ms", figures.line_latency);
  json["stolen"] = figures.stolen;
  return json;
}

} // namespace

hal::Result<ChainReport> bench_chain(const ChainOptions& options,
                                     const std::function<void(const ChainResult&)>& tell) {
  HAL_TRY(auto folder, BenchFolder::make());
  return Bench{Chain{std::move(folder), options}, options, tell}.run();
}

std::string to_json(const ChainReport& report) {
  nlohmann::ordered_json json{
      {"cpu", report.cpu},
      {"display", fmt::format("offscreen, {}x{}", report.size[0], report.size[1])},
      {"cases", nlohmann::ordered_json::array()},
      {"highest_line_rate_hz",
       {{"reconstruct_only", report.reconstruct_only_hz},
        {"with_display", report.with_display_hz}}}};
  for (const ChainResult& result : report.cases)
    json["cases"].push_back(json_of(result));
  return json.dump(2);
}

} // namespace octascope::firmware_host
