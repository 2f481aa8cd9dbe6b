// The report of a run: its keys stay, tools read them.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "firmware-host/supervision/appliance_status.h"
#include "hal/clock.h"
#include "hal/result.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/reconstruction/path_choice.h"
#include "pipeline/scan/scan_lag_thread.h"
#include "pipeline/scan/scan_plan.h"
#include "pipeline/threads/duration_statistics.h"
#include "ui/scene/ray_trial.h"
#include "ui/view/view_state.h"

namespace octascope::firmware_host {

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
  pipeline::ScanLagStatus phase;
  std::vector<int> worker_cores; // by worker; −1 where the system chooses

  // The books balance (ARCHITECTURE.md, "What counts as lost"):
  //   planned = acquired + lost_volumes + unfinished
  //   acquired = displayed + skipped + undisplayed
  std::uint64_t planned = 0;   // ticks since the camera first streamed
  std::uint64_t acquired = 0;  // of which at least one B-scan came
  std::uint64_t published = 0; // the same, when they were ready to be shown
  std::uint64_t displayed = 0; // in a frame that reached the glass
  std::uint64_t skipped = 0;   // never taken by the renderer: a newer one came, FROZEN, or the end
  std::uint64_t undisplayed = 0; // taken, and then the display failed: "lost" of the volumes
  std::uint64_t unfinished = 0;  // under way when the run ended
  std::uint64_t lost_lines = 0, lost_b_scans = 0, lost_volumes = 0;
  std::uint64_t saturated_lines = 0;
  double duration_s = 0;
  double lines_per_s = 0, volumes_per_s = 0, frames_per_s = 0;
  pipeline::DurationSummary reconstruct, assemble, publish, upload, draw, latency, control;
  std::optional<ui::RayTrial> rays;
  std::optional<double> first_picture_s; // since the process began
  std::uint64_t frames_drawn = 0, frames_missed = 0;
  std::uint64_t hot_path_allocations = 0;
  ui::ViewState view;                                    // as it was left
  std::array<std::uint64_t, ui::action_count> actions{}; // how often each was done
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
