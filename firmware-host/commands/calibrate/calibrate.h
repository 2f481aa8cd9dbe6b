// octascope calibrate: turns measurements of a spectrometer into the calibration that every command
// takes, and judges it.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "firmware-host/commands/calibrate/calibrate_verdict.h"
#include "hal/result.h"
#include "pipeline/calibration_finder/mirror_pair.h"
#include "pipeline/reconstruction/spectra_file.h"

namespace octascope::firmware_host {

// Light that is not interference. With `plain`, their mean is subtracted from each mirror; else
// sample arm and reference arm, each with the other one blocked, are subtracted, and what both
// contain (no light at all) is added once where both are given.
struct DarkFiles {
  std::vector<std::filesystem::path> plain;
  std::optional<std::filesystem::path> none;
  std::optional<std::filesystem::path> reference;
  std::vector<std::filesystem::path> sample; // one, or one for each mirror
};

struct CalibrateOptions {
  std::vector<std::filesystem::path> mirrors; // none or two
  DarkFiles darks;
  std::optional<pipeline::SampleSide> side; // empty: decided by the tissue, else both mirrors
  std::optional<std::filesystem::path> lamp;
  std::vector<double> lines_nm;
  std::optional<std::filesystem::path> tissue;
  std::optional<pipeline::SpectraShape> tissue_shape; // empty: the file says it
  std::optional<std::filesystem::path> base;  // calibration whose k curve is used for the tissue
  std::optional<int> samples;                 // empty: each file is one line
  std::optional<hal::SampleType> type;        // empty: from the file's name, else u16
  std::optional<hal::SampleType> tissue_type; // likewise
  std::optional<int> significant_bits;        // full scale of counts
  std::optional<double> mirror_distance_um;
  std::optional<double> spacing_um;
  std::optional<double> refractive_index; // for which depths are reported
  std::string camera;                     // which the measurements were made with; empty: unknown
  std::filesystem::path out;
  std::optional<std::filesystem::path> picture;
};

// Refuses options that contradict each other.
hal::Result<> check(const CalibrateOptions& options);

// Checks the options; writes files only if everything succeeded.
hal::Result<CalibrationVerdict> calibrate(const CalibrateOptions& options);

// As add_reconstruct_command().
void add_calibrate_command(CLI::App& app, int& exit_status);

} // namespace octascope::firmware_host
