// The appliance's configuration file: one TOML, refused as a whole when anything in it is wrong.
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
#include "ui/controls/built_in_profiles.h"
#include "ui/transfer/auto_window.h"

namespace octascope::firmware_host {

struct Configuration {
  // [scan]; empty: the phantom's or the recording's own plan
  std::optional<pipeline::ScanPlan> plan;
  bool depth_spacing_said = false; // in [scan]; else a real camera's calibration says it
  // [calibration], or the objective's
  std::optional<std::filesystem::path> calibration;
  // [[objective]] and [microscope]
  std::vector<Objective> objectives;
  std::optional<Objective> objective; // the one that is on the microscope
  // [pipeline]
  std::size_t workers = 0;                      // 0: one a core
  std::vector<int> worker_cores;                // taken in turns; empty: spread over the allowed
  pipeline::NeighbourWeights neighbour_weights; // each B-scan's share in its picture
  // [devices]
  DeviceConfig devices;
  // [display]
  int width = 1280;
  int height = 720;
  bool fullscreen = false;
  std::optional<ui::DisplayWindow> window; // empty: what suits the first volume; the objective's
  hal::Duration veil_after = std::chrono::seconds{5};
  // [[transfer]] and [display]
  LookConfiguration look;
  // [controls]
  std::optional<std::string> control_profile; // one that the program brings; empty: as plugged in
  std::optional<std::filesystem::path> control_file; // in its place
  // [observation]
  std::optional<std::filesystem::path> metrics; // written anew every ten seconds
  // [recordings]
  std::optional<std::filesystem::path> recording_folder;
  // [sim]
  std::string phantom = "anterior_eye";
  int loop_volumes = 6;
  double galvo_lag_us = 25; // of the mirror, in a bidirectional scan
  std::optional<std::filesystem::path> faults;
  std::optional<std::filesystem::path> controls;
};

// The file that a run is configured by: --config, else the machine's where there is one; not for a
// simulation, which is the same on every machine.
inline constexpr const char* machine_configuration = "/etc/octascope/octascope.toml";
std::optional<std::filesystem::path> configuration_file(const RunOptions& options);

// Paths in the file are relative to it.
hal::Result<Configuration> load_configuration(const std::filesystem::path& file);
hal::Result<Configuration> read_configuration(const pipeline::ConfigDocument& document);

// That file, read; without one the defaults.
hal::Result<Configuration> configuration_of(const RunOptions& options);

// What the objective says of the scan, and then the command line, come before what anything else
// says.
void override_plan(const RunOptions& options, const Configuration& configuration,
                   pipeline::ScanPlan& plan);

// How the beam moves, by configuration and command line.
pipeline::ScanPlan plan_of(const RunOptions& options, const Configuration& configuration);

// What pedals and knobs do, from where the configuration says; else the default profile.
hal::Result<ui::ControlProfile> load_controls(const Configuration& configuration);

} // namespace octascope::firmware_host
