#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/bench/bench_command.h"
#include "firmware-host/commands/bench/bench_display.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/numbers.h"
#include "firmware-host/commands/volume/flow_file.h"
#include "firmware-host/report/report_parts.h"
#include "firmware-host/run/volume_source.h"
#include "firmware-host/terminal/terminal.h"

namespace octascope::firmware_host {

namespace {

struct BenchDisplayArguments {
  bool as_json = false;
  double seconds = 90;
  std::string volume;
  std::string flow;
  std::string size;
  std::string technique;
  std::string drawn_by;
  std::string dump;
  bool no_live = false;
};

void print_text(const DisplayBenchReport& report) {
  say("{}\n{}\nvolume {} x {} x {}, window {:.1f} dB from {:.1f} dB; eight directions\n\n"
      "technique drawn by   size       step   opacity     flow ms p50  ms p95  difference\n",
      report.cpu, report.gl_renderer, report.geometry.depths, report.geometry.a_scans,
      report.geometry.b_scans, report.window_size_db, report.window_offset_db);
  for (const DisplayBenchResult& result : report.cases)
    say("{:<9} {:<10} {:<10} 1/{:<4} {:<11} {:<3} {:>7.1f} {:>7.1f}  {}\n",
        to_string(result.what.technique),
        result.what.backend == ui::RayBackend::processor ? "processor" : "gl",
        fmt::format("{}x{}", result.what.width, result.what.height), result.what.steps,
        result.what.opaque ? "opaque" : "translucent", result.what.flow ? "yes" : "no",
        result.ms_p50, result.ms_p95,
        result.difference ? fmt::format("{:.2f}", *result.difference) : "-");
  say("\nupload {:.2f} ms a volume{}; occupancy {:.3f} ms a B-scan\n", report.upload_ms_p50,
      report.upload_with_flow_ms_p50
          ? fmt::format(", with flow {:.2f} ms", *report.upload_with_flow_ms_p50)
          : "",
      report.occupancy_ms_per_b_scan);
  if (const auto& live = report.live)
    say("live at 1280x720: first picture after {:.0f} ms; {:.1f} frames/s while the view "
        "turns, knob to frame {:.0f} ms (p95 {:.0f}); last line to frame {:.0f} ms (p95 "
        "{:.0f}), at rest {:.0f} ms (p95 {:.0f}); turning at {}, at rest at {}\n",
        live->start_to_first_picture_ms, live->frames_per_s, live->knob_to_frame_ms_p50,
        live->knob_to_frame_ms_p95, live->latency_ms_p50, live->latency_ms_p95,
        live->resting_latency_ms_p50, live->resting_latency_ms_p95, to_text(live->turning_quality),
        to_text(live->resting_quality));
}

int run(const BenchDisplayArguments& arguments) {
  VolumeRequest request;
  if (arguments.volume.empty())
    request.phantom = "anterior_eye";
  else
    request.file = arguments.volume;
  DisplayBenchOptions options;
  if (!arguments.size.empty()) {
    const auto size = parse_size(arguments.size);
    if (!size)
      return complain("bench display", size.error());
    options.sizes = {*size};
  }
  options.technique = ui::technique_named(arguments.technique);
  if (!arguments.drawn_by.empty())
    options.rays =
        arguments.drawn_by == "processor" ? ui::RayBackend::processor : ui::RayBackend::shader;
  auto loaded = load_volume(request);
  if (!loaded)
    return complain("bench display", loaded.error());
  if (!arguments.flow.empty())
    if (const auto read = read_flow_beside(arguments.flow, loaded->volume); !read)
      return complain("bench display", read.error());
  for (const std::string& remark : loaded->remarks)
    warn("octascope bench display: {}\n", remark);
  options.seconds = arguments.seconds;
  options.live = !arguments.no_live;
  if (!arguments.dump.empty())
    options.dump = arguments.dump;
  const auto report = bench_display(loaded->volume, options);
  if (!report)
    return complain("bench display", report.error());
  if (arguments.as_json)
    say("{}\n", to_json(*report));
  else
    print_text(*report);
  return exit_done;
}

} // namespace

void add_bench_display_command(CLI::App& bench, int& exit_status) {
  auto arguments = std::make_shared<BenchDisplayArguments>();
  CLI::App* command = bench.add_subcommand(
      "display", "Milliseconds a picture of each technique, and of the whole appliance");
  command->add_flag("--json", arguments->as_json, "One JSON object");
  CLI::Option* const volume =
      command
          ->add_option("--volume", arguments->volume,
                       "Volume to draw (NRRD); else the simulated eye, 512 x 300 x 80")
          ->type_name("FILE");
  command
      ->add_option("--flow", arguments->flow,
                   "What flows in it: each picture is measured without and with it (NRRD of the "
                   "same shape, as reconstruct --flow writes it)")
      ->type_name("FILE.nrrd")
      ->needs(volume);
  command
      ->add_option("--size", arguments->size,
                   "Of the pictures, as 1280x720; else 640x360, 1280x720 and 1920x1080")
      ->type_name("WxH");
  std::vector<std::string> names;
  for (const ui::Technique technique : ui::all_techniques)
    names.emplace_back(to_string(technique));
  command->add_option("--technique", arguments->technique, "Only this one")
      ->check(CLI::IsMember(names));
  command
      ->add_option("--drawn-by", arguments->drawn_by, "Rays cast by the processor, or by GL, only")
      ->check(CLI::IsMember({"processor", "gl"}));
  command
      ->add_option("--seconds", arguments->seconds,
                   "About how long the drawing is measured (90 if not given)")
      ->check(within(0.1, 3600.0));
  command
      ->add_option("--dump", arguments->dump, "Folder for the volume and each case's picture (PNG)")
      ->type_name("FOLDER");
  command->add_flag("--no-live", arguments->no_live, "Leave out the run of the whole appliance");
  command->footer("Example: octascope bench display --json --dump pictures");
  command->callback([arguments, &exit_status] { exit_status = run(*arguments); });
}

} // namespace octascope::firmware_host
