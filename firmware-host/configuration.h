// The appliance's configuration file: one TOML, refused as a whole when anything in it is wrong.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "firmware-host/look_configuration.h"
#include "hal/clock.h"
#include "hal/result.h"
#include "pipeline/neighbour_average.h"
#include "pipeline/scan_plan.h"
#include "ui/auto_window.h"
#include "ui/controls/built_in_profiles.h"

namespace octascope::firmware_host {

struct Configuration {
  // [scan]; empty: the phantom's or the recording's own plan
  std::optional<pipeline::ScanPlan> plan;
  // [calibration]
  std::optional<std::filesystem::path> calibration;
  // [pipeline]
  std::size_t workers = 0;                      // 0: one a core
  std::vector<int> worker_cores;                // taken in turns; empty: spread over the allowed
  pipeline::NeighbourWeights neighbour_weights; // each B-scan's share in its picture
  // [display]
  int width = 1280;
  int height = 720;
  bool fullscreen = false;
  std::optional<ui::DisplayWindow> window; // empty: what suits the first volume
  hal::Duration veil_after = std::chrono::seconds{5};
  // [[transfer]] and [display]
  LookConfiguration look;
  // [controls]
  std::string control_profile{ui::default_profile};  // one that the program brings with it
  std::optional<std::filesystem::path> control_file; // in its place
  // [sim]
  std::string phantom = "anterior_eye";
  int loop_volumes = 6;
  double galvo_lag_us = 25; // of the mirror, in a bidirectional scan
  std::optional<std::filesystem::path> faults;
  std::optional<std::filesystem::path> controls;
};

// Paths in the file are relative to it.
hal::Result<Configuration> load_configuration(const std::filesystem::path& file);

// What pedals and knobs do, from where the configuration says.
hal::Result<ui::ControlProfile> load_controls(const Configuration& configuration);

} // namespace octascope::firmware_host
