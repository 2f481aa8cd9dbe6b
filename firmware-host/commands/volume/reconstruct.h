// octascope reconstruct: raw spectra → a volume of levels, and a picture of one B-scan.
#pragma once

#include <filesystem>
#include <optional>

#include <CLI/CLI.hpp>

#include "hal/result.h"
#include "pipeline/reconstruction/spectra_file.h"

namespace octascope::firmware_host {

struct ReconstructOptions {
  std::filesystem::path spectra;
  pipeline::SpectraShape shape;
  hal::SampleType type = hal::SampleType::u16;
  std::optional<int> significant_bits;              // none: as many as the type has
  int right_shift = 0;                              // of left-justified counts
  std::optional<std::filesystem::path> calibration; // none: no resampling, no dispersion
  std::filesystem::path volume;                     // NRRD to write
  bool display_counts = false;                      // 8 bits instead of float dB
  int picture_b_scan = 0;
  std::optional<std::filesystem::path> picture; // PNG to write
  unsigned threads = 0;                         // 0: one a core
};

// ErrorCode::invalid_argument for what a user can put right on the command line.
hal::Result<> reconstruct_volume(const ReconstructOptions& options);

// Adds the command to `app`. When the user gives it, it runs while `app` parses and puts 0 (done),
// 1 (failed) or 2 (wrong use) into `exit_status`, which must live as long as `app`.
void add_reconstruct_command(CLI::App& app, int& exit_status);

} // namespace octascope::firmware_host
