// The appliance's configuration file: one TOML, refused as a whole if anything in it is wrong.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "firmware-host/configuration/device_config.h"
#include "firmware-host/configuration/look_configuration.h"
#include "firmware-host/configuration/objective.h"
#include "firmware-host/configuration/run_options.h"
#include "hal/clock.h"
#include "hal/result.h"
#include "pipeline/acquisition/neighbour_average.h"
#include "pipeline/files/config_document.h"
#include "pipeline/scan/scan_plan.h"
#include "sim/spectra/tissue_motion.h"
#include "ui/controls/built_in_profiles.h"
#include "ui/status/axis_words.h"
#include "ui/transfer/auto_window.h"

namespace octascope::firmware_host {

struct Configuration {
  // [scan]; empty: the phantom's or the recording's own plan
  std::optional<pipeline::ScanPlan> plan;
  bool depth_spacing_said = false; // by [scan]; else a real camera's calibration gives it
  // [calibration], or the objective's
  std::optional<std::filesystem::path> calibration;
  // [[objective]] and [microscope]
  std::vector<Objective> objectives;
  std::optional<Objective> objective; // the one mounted on the microscope
  // [pipeline]
  std::size_t workers = 0;                      // 0: one per core
  std::vector<int> worker_cores;                // assigned in turn; empty: spread over the allowed
                                                // cores
  pipeline::NeighbourWeights neighbour_weights; // weights of neighbouring B-scans in each B-scan's
                                                // picture
  bool flow = false;                            // repeats are compared, and volumes say what flows
  // [devices]
  DeviceConfig devices;
  // [display]
  int width = 1280;
  int height = 720;
  bool fullscreen = false;
  std::optional<ui::DisplayWindow> window; // empty: the objective's, or chosen for the first volume
  hal::Duration veil_after = std::chrono::seconds{5};
  // [[transfer]] and [display]
  LookConfiguration look;
  // [orientation]
  ui::ScanOrientation orientation;
  // [controls]
  std::optional<std::string> control_profile;        // built in; empty: chosen by the device
  std::optional<std::filesystem::path> control_file; // instead of a built-in profile
  // [observation]
  std::optional<std::filesystem::path> metrics; // rewritten every ten seconds
  // [recordings]
  std::optional<std::filesystem::path> recording_folder;
  // [sim]
  std::string phantom = "anterior_eye";
  int loop_volumes = 6;
  double galvo_lag_us = 25; // of the mirror, in a bidirectional scan
  sim::TissueMotion tissue_motion;
  std::optional<std::filesystem::path> faults;
  std::optional<std::filesystem::path> controls;
};

// The configuration of a run: --config, else the machine's if present. Simulations ignore the
// machine's, so that they are the same everywhere.
inline constexpr const char* machine_configuration = "/etc/octascope/octascope.toml";
std::optional<std::filesystem::path> configuration_file(const RunOptions& options);

// Paths in the file are relative to it.
hal::Result<Configuration> load_configuration(const std::filesystem::path& file);
// The file's text, to be kept with what was made with it; empty where it cannot be read.
std::string configuration_text(const std::filesystem::path& file);
hal::Result<Configuration> read_configuration(const pipeline::ConfigDocument& document);

// Loads that file; without one, the defaults.
hal::Result<Configuration> configuration_of(const RunOptions& options);

// Applies the objective's scan size and then the command line, which take precedence over all else.
void override_plan(const RunOptions& options, const Configuration& configuration,
                   pipeline::ScanPlan& plan);

// The scan plan from configuration and command line.
pipeline::ScanPlan plan_of(const RunOptions& options, const Configuration& configuration);

// Whether volumes shall say what flows.
bool tells_flow(const RunOptions& options, const Configuration& configuration);

// The control profile that the configuration names, else the default one.
hal::Result<ui::ControlProfile> load_controls(const Configuration& configuration);

} // namespace octascope::firmware_host
