// The report of a run. Its keys are a contract: tools read them.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "firmware-host/ledger/passage.h"
#include "firmware-host/ledger/shown_quality.h"
#include "firmware-host/supervision/appliance_status.h"
#include "firmware-host/supervision/run_counters.h"
#include "hal/clock.h"
#include "hal/result.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/reconstruction/path_choice.h"
#include "pipeline/scan/scan_lag_thread.h"
#include "pipeline/scan/scan_plan.h"
#include "pipeline/threads/duration_statistics.h"
#include "ui/scene/ray_trial.h"
#include "ui/status/freshness.h"
#include "ui/view/view_state.h"

namespace octascope::firmware_host {

// What the display showed at the end, as in the snapshot.
struct ShownPicture {
  ui::Freshness freshness;
  std::string notice;      // empty: none
  int missing_b_scans = 0; // of the shown volume
  int saturated_lines = 0;
  bool another_camera = false; // than the calibration's
};

// Volumes by length: those below most_ms of the first bin, of the second…, and above the last.
struct StageSummary {
  static constexpr std::array most_ms{0.1,  0.2,  0.5,  1.0,   2.0,   5.0,
                                      10.0, 20.0, 50.0, 100.0, 200.0, 500.0};

  pipeline::DurationSummary lengths;
  std::array<std::uint64_t, most_ms.size() + 1> histogram{};
};

// Of volumes that say what flows (docs/ANGIOGRAPHY.md).
struct FlowSummary {
  std::uint64_t angiograms = 0; // published volumes, all B-scans of which were compared
  // B-scans of published volumes: told; moved too far between sweeps; neither.
  std::uint64_t told = 0, left_out = 0, none = 0;
  std::uint64_t no_time = 0;      // B-scans without flow since workers were behind
  pipeline::DurationSummary tell; // a worker's time for one B-scan, its reconstruction apart
};

// Trees that were traced in the volumes' flow.
struct TracedTreesSummary {
  std::uint64_t traced = 0;
  std::uint64_t refused = 0; // not among the traced
  pipeline::DurationSummary took;
};

struct RunReport {
  bool simulated = false;
  std::string source;                // what the spectra were
  std::string reconstruction_path;   // "fused" or "fftw"
  std::string reconstruction_isa;    // its instruction set
  std::string reconstruction_reason; // pipeline::PathReason's name
  std::optional<pipeline::PathTimes> reconstruction_times;
  std::string line_camera, galvo_trigger, control_input, scope_camera, display; // backends

  CalibrationAccount calibration;

  pipeline::ScanPlan plan;
  pipeline::ScanLagStatus scan_lag;
  std::vector<int> worker_cores; // by worker; −1 where the system chooses

  RunCounters counters; // complete once the threads have ended
  double duration_s = 0;
  pipeline::DurationSummary reconstruct, assemble, publish, upload, draw, control;
  pipeline::DurationSummary line_latency;       // of every line that was shown
  std::array<StageSummary, stage_count> stages; // of the latency
  std::optional<FlowSummary> flow;              // empty: nobody asked
  QualitySummary quality;                       // of the shown frames
  std::optional<ui::RayTrial> rays;
  std::optional<TracedTreesSummary> trees; // empty: the volumes come without flow
  std::optional<double> first_picture_s;   // since the process began
  ShownPicture picture;
  ui::ViewState view;                                    // at the end of the run
  std::array<std::uint64_t, ui::action_count> actions{}; // times each was performed
  std::vector<pipeline::FaultRecord> faults;
  hal::TimePoint started; // fault times are relative to it
};

// One JSON object, indented.
std::string to_json(const RunReport& report);

// The same for a person: a few lines.
std::string to_text(const RunReport& report);

// Whole or not at all.
hal::Result<> write_report(const RunReport& report, const std::filesystem::path& file);

} // namespace octascope::firmware_host
