// octascope bench flow: flow, and vessels traced in it, against what is true of a simulated bed of
// vessels, from raw spectra on.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <CLI/App.hpp>

#include "firmware-host/commands/bench/flow/flow_tally.h"
#include "hal/result.h"
#include "pipeline/angiography/kernel_sums.h"
#include "pipeline/angiography/static_tissue.h"
#include "pipeline/scan/scan_plan.h"
#include "pipeline/vessels/tracing/vessel_tracer.h"
#include "pipeline/vessels/tree_comparison.h"
#include "sim/spectra/tissue_motion.h"

namespace octascope::firmware_host {

// Of a run that tells flow while it displays, on the twin.
struct LiveFlowFigures {
  double line_rate_hz = 0;
  double planned_per_s = 0; // volumes
  // The share of the planned ones, all B-scans of which were compared, at that rate.
  double angiograms_per_s = 0;
  double compared_share = 0; // of the B-scans that came
  double lost_lines = 0;
  double left_out_share = 0; // of them: moved too far
  double b_scan_ms_p50 = 0;  // a worker's time for the flow of one
  double b_scan_ms_p95 = 0;
};
using FlowProbe = std::function<hal::Result<LiveFlowFigures>(int repeats)>;

struct FlowBenchOptions {
  std::vector<int> repeats{2, 4};
  int b_scans = pipeline::ScanPlan{}.b_scans; // the middle ones of the phantom's field
};

// 10 µm to either side, as fast as a hand trembles: up to 2.2 µm from one repeat to the next.
sim::TissueMotion bench_motion();

// Vessels of which the centreline is looked for: 4 A-scans wide or more.
inline constexpr double traced_radius_um = 20;

// `comparison` without meaning where the tree was refused.
struct TreeFigures {
  std::string refusal;
  double quality = 0;
  pipeline::TreeComparison comparison;
};

struct FlowBenchCase {
  int repeats = 0;
  pipeline::FlowMethod method = pipeline::FlowMethod::complex_bins;
  int left_out_b_scans = 0; // moved too far; their voxels are not told
  FlowFigures flow;
  TreeFigures tree;
  std::optional<LiveFlowFigures> live; // by complex bins, which a run uses
};

struct FlowBenchReport {
  pipeline::ScanPlan plan; // but for its repeats
  std::vector<FlowBenchCase> cases;
};

// Both methods for each number of repeats, on all cores. Takes about 5 s a repeat of 80 B-scans on one
// core, and 62 MB, and what `probe` takes, once for each number of repeats when nothing else is
// computed. `progress`: words for what is done at the moment.
hal::Result<FlowBenchReport> bench_flow(const FlowBenchOptions& options, const FlowProbe& probe,
                                        const std::function<void(const std::string&)>& progress);

// Vessels traced in the flow of the whole field, by complex bins.
hal::Result<pipeline::TracedVessels> trace_bench_scene(int repeats);

std::string to_text(const FlowBenchReport& report);
std::string to_json(const FlowBenchReport& report);

// `exit_status` as in add_run_command().
void add_bench_flow_command(CLI::App& bench, int& exit_status, FlowProbe probe);

} // namespace octascope::firmware_host
