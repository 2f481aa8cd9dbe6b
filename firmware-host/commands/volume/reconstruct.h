// octascope reconstruct: turns raw spectra into a volume of levels and a picture of one B-scan; repeated
// sweeps into a volume of what flows as well.
#pragma once

#include <filesystem>
#include <optional>

#include <CLI/CLI.hpp>

#include "hal/result.h"
#include "pipeline/reconstruction/spectra_file.h"

namespace octascope::firmware_host {

struct ReconstructOptions {
  std::filesystem::path spectra;
  std::optional<pipeline::SpectraShape> shape; // of plain spectra; a recording says it itself
  std::optional<std::size_t> raw_volume;       // of a recording, from 0; empty: the first whole one
  hal::SampleType type = hal::SampleType::u16;
  std::optional<int> significant_bits; // empty: all of the type's
  int right_shift = 0;                 // of left-justified counts
  // Empty: a recording's own; else no resampling and no dispersion compensation.
  std::optional<std::filesystem::path> calibration;
  std::optional<int> repeats; // successive sweeps of one position; empty: a recording's own, else 1
  std::filesystem::path volume; // NRRD to write
  // Likewise, of repeats: what flows, and how far they decorrelate before anything is decided.
  std::optional<std::filesystem::path> flow;
  std::optional<std::filesystem::path> decorrelation;
  bool display_counts = false; // 8 bits instead of float dB
  int picture_b_scan = 0;
  std::optional<std::filesystem::path> picture; // PNG to write
  unsigned threads = 0;                         // 0: one per core
};

// ErrorCode::invalid_argument for what a user can correct on the command line.
hal::Result<> reconstruct_volume(const ReconstructOptions& options);

// Adds the command to `app`. If given, it runs while `app` parses and stores 0 (done), 1 (failed)
// or 2 (wrong use) in `exit_status`, which must outlive `app`.
void add_reconstruct_command(CLI::App& app, int& exit_status);

} // namespace octascope::firmware_host
