// octascope vessels trace: a flow volume to a vessel tree.
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "firmware-host/commands/arguments.h"
#include "firmware-host/commands/command.h"
#include "firmware-host/commands/vessels/vessels.h"
#include "firmware-host/terminal/terminal.h"
#include "firmware-host/version/version.h"
#include "firmware-host/vessels/vessel_files.h"
#include "pipeline/files/nrrd.h"
#include "pipeline/vessels/tracing/vessel_tracer.h"
#include "pipeline/vessels/tree_summary.h"

namespace octascope::firmware_host {

namespace {

struct VesselsTraceCommandLine {
  std::filesystem::path file;
  std::filesystem::path out;
  bool json = false;
};

struct TraceReport {
  pipeline::TracedVessels traced;
  pipeline::TreeSummary summary;
  double seconds = 0; // of tracing alone
};

hal::Result<pipeline::NrrdVolume> read_flow(const std::filesystem::path& file) {
  HAL_TRY(auto volume, pipeline::read_nrrd(file));
  if (!std::holds_alternative<std::vector<float>>(volume.levels))
    return hal::fail(hal::ErrorCode::bad_data,
                     "{}: found 8-bit levels, expected a flow volume: numbers from 0 (static) to 1 "
                     "(flowing)",
                     file.string());
  // As `reconstruct --decorrelation` notes it. In noise all decorrelates: a tree would be found in it.
  if (volume.content.starts_with("decorrelation"))
    return hal::fail(
        hal::ErrorCode::bad_data,
        "{}: found decorrelation, expected a flow volume: octascope reconstruct --flow "
        "writes one",
        file.string());
  if (volume.geometry.assumed.any())
    return hal::fail(hal::ErrorCode::bad_data,
                     "{}: found no spacing ({}), expected those of all three axes: a tree in "
                     "millimetres needs them",
                     file.string(), volume.geometry.assumed.words());
  return volume;
}

hal::Result<TraceReport> trace(const std::filesystem::path& file) {
  HAL_TRY(const auto volume, read_flow(file));
  for (const std::string& remark : volume.remarks)
    warn("octascope vessels trace: {}: {}\n", file.string(), remark);
  const auto begun = std::chrono::steady_clock::now();
  auto traced =
      pipeline::VesselTracer{}.trace(volume.geometry, std::get<std::vector<float>>(volume.levels));
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begun;
  if (!traced)
    return hal::fail(traced.error().code, "{}: {}", file.string(), traced.error().message);
  if (!traced->refusal.empty())
    return hal::fail(hal::ErrorCode::bad_data, "{}: no tree is written: {}", file.string(),
                     traced->refusal);
  const pipeline::TreeSummary summary = pipeline::summarise(traced->tree);
  return TraceReport{std::move(*traced), summary, took.count()};
}

std::string to_text(const TraceReport& report, const VesselsTraceCommandLine& line) {
  const auto& [traced, summary, seconds] = report;
  std::string text = fmt::format(
      "{}: {} trees, {} nodes, {} branch points, {} tips, {:.2f} mm, radii {:.0f} to {:.0f} µm\n"
      "quality {:.2f}: vessels explain {:.0f} % of what flows, are {:.0f} % round and stand out by "
      "{:.0f} %\n"
      "traced in {:.2f} s\n",
      line.out.string(), summary.roots, summary.nodes, summary.branch_points, summary.tips,
      summary.length_mm, static_cast<double>(summary.smallest_radius_mm) * 1e3,
      static_cast<double>(summary.largest_radius_mm) * 1e3, traced.quality,
      traced.explained_share * 100, traced.roundness * 100, traced.contrast * 100, seconds);
  if (traced.moved_b_scans > 0)
    text += fmt::format("{} B-scans flow as a whole and were left out\n", traced.moved_b_scans);
  return text;
}

std::string to_json(const TraceReport& report, const VesselsTraceCommandLine& line) {
  const auto& [traced, summary, seconds] = report;
  return nlohmann::ordered_json{{"out", line.out.string()},
                                {"nodes", summary.nodes},
                                {"roots", summary.roots},
                                {"branch_points", summary.branch_points},
                                {"tips", summary.tips},
                                {"length_mm", summary.length_mm},
                                {"smallest_radius_mm", summary.smallest_radius_mm},
                                {"largest_radius_mm", summary.largest_radius_mm},
                                {"quality", traced.quality},
                                {"explained_share", traced.explained_share},
                                {"roundness", traced.roundness},
                                {"contrast", traced.contrast},
                                {"moved_b_scans", traced.moved_b_scans},
                                {"seconds", seconds}}
             .dump(2) +
         "\n";
}

hal::Result<> run(const VesselsTraceCommandLine& line) {
  HAL_TRY(const auto report, trace(line.file));
  HAL_CHECK(write_tree(
      line.out, report.traced.tree,
      fmt::format("traced in {} by octascope {}", line.file.filename().string(), version())));
  say("{}", line.json ? to_json(report, line) : to_text(report, line));
  return {};
}

} // namespace

void add_vessels_trace_command(CLI::App& vessels, int& exit_status) {
  CLI::App* command =
      vessels.add_subcommand("trace", "A flow volume to a vessel tree: centrelines and radii");
  auto line = std::make_shared<VesselsTraceCommandLine>();
  command
      ->add_option("file", line->file,
                   "Flow volume as NRRD: 0 static to 1 flowing, NaN unknown, with its spacings")
      ->required()
      ->type_name("FILE.nrrd");
  command
      ->add_option(
          "--out", line->out,
          "Tree to write, in the volume's frame: .swc for SWC, .vtp for VTK, .vessels for our own "
          "format")
      ->required()
      ->type_name("FILE.swc|.vtp|.vessels");
  command->add_flag("--json", line->json, "The result as one JSON object");
  command->footer("Nothing is written where the tree explains too little of what flows "
                  "(docs/VESSELS.md).\n"
                  "Example: octascope vessels trace flow.nrrd --out tree.swc");
  command->callback([line, &exit_status] {
    const auto done = run(*line);
    exit_status = done ? exit_done : complain("vessels trace", done.error());
  });
}

} // namespace octascope::firmware_host
