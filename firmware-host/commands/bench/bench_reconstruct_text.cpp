#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "firmware-host/commands/bench/bench_reconstruct.h"

namespace octascope::firmware_host {

namespace {

using pipeline::BackgroundMode;
using pipeline::Interpolation;
using pipeline::ReconstructionPath;

const char* path_name(ReconstructionPath path) {
  return path == ReconstructionPath::fused ? "fused" : "fftw";
}

const char* interpolation_name(Interpolation interpolation) {
  switch (interpolation) {
  case Interpolation::linear: return "linear";
  case Interpolation::cubic: return "cubic";
  case Interpolation::sinc8: break;
  }
  return "sinc8";
}

const char* background_name(BackgroundMode background) {
  switch (background) {
  case BackgroundMode::file: return "recorded";
  case BackgroundMode::running: return "running";
  case BackgroundMode::none: return "none";
  case BackgroundMode::mean: break;
  }
  return "mean";
}

} // namespace

std::string to_text(const BenchReport& report) {
  std::string text =
      fmt::format("{}\nbare FFTW c2c {}: {:.0f} ns; raw data from a ring of {:.0f} MB; medians, "
                  "spread between the quartiles\n\n"
                  "path   isa     taps    dispersion background threads  lines/s   "
                  "x FFTW  spread  "
                  "error  differing\n",
                  report.cpu, bench_samples, report.fftw_c2c_ns, report.ring_mb);
  for (const BenchResult& result : report.cases)
    fmt::format_to(
        std::back_inserter(text),
        "{:<6} {:<7} {:<7} {:<10} {:<10} {:>7} {:>8.0f} k {:>7.3f} {:>6.1f} % {:>5} {:>8.3f} %\n",
        path_name(result.what.path), result.what.isa, interpolation_name(result.what.interpolation),
        result.what.dispersion ? "yes" : "no", background_name(result.what.background),
        result.what.threads, result.lines_per_s / 1000, result.ratio_to_fftw, 100 * result.spread,
        result.max_count_error, 100 * result.share_differing);
  return text;
}

std::string to_json(const BenchReport& report) {
  nlohmann::ordered_json json{
      {"cpu", report.cpu}, {"fftw_c2c_1024_ns", report.fftw_c2c_ns}, {"ring_mb", report.ring_mb}};
  auto& list = json["cases"] = nlohmann::ordered_json::array();
  for (const BenchResult& result : report.cases)
    list.push_back({{"path", path_name(result.what.path)},
                    {"isa", result.what.isa},
                    {"samples", bench_samples},
                    {"interpolation", interpolation_name(result.what.interpolation)},
                    {"dispersion", result.what.dispersion},
                    {"background", background_name(result.what.background)},
                    {"threads", result.what.threads},
                    {"lines_per_s", result.lines_per_s},
                    {"ratio_to_fftw", result.ratio_to_fftw},
                    {"spread", result.spread},
                    {"repeats", result.repeats},
                    {"max_count_error", result.max_count_error},
                    {"share_differing", result.share_differing}});
  return json.dump(2);
}

} // namespace octascope::firmware_host
