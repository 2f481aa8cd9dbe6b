// octascope export: volumes of a recording → NRRD, DICOM, PNG.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include <CLI/CLI.hpp>

#include "firmware-host/commands/arguments.h"
#include "hal/result.h"
#include "ui/transfer/auto_window.h"

namespace octascope::firmware_host {

enum class ExportFormat : std::uint8_t { nrrd, dicom, png };

struct ExportOptions {
  std::filesystem::path recording;
  ExportFormat format = ExportFormat::nrrd;
  std::filesystem::path out; // a file with the format's extension for one volume, else a folder
  VolumeRange volumes;
  bool display_counts = false;             // NRRD: 8 bits instead of float dB
  std::optional<int> b_scan;               // PNG; empty: en face, from above
  bool to_scale = false;                   // PNG: square pixels
  std::optional<ui::DisplayWindow> window; // DICOM, PNG; empty: chosen for the first volume
  std::optional<std::string> subject;      // DICOM, NRRD: replaces the recording's
};

struct ExportOutcome {
  std::size_t volumes = 0;
  std::filesystem::path first, last;       // files
  std::optional<ui::DisplayWindow> window; // used to show the volumes
  std::size_t missing_b_scans = 0;         // in the exported volumes
  bool simulated = false;
  std::string assumed_spacings; // VolumeGeometry::assumed, in words; empty: none
  std::string pixels;           // PNG: their pixel size, as text
};

// Files appear complete or not at all, replace files of the same name, and are readable by their
// owner alone, since they show a patient. ErrorCode::invalid_argument for what a user can correct
// on the command line. After a failure, files finished before remain. `progress` receives 0 to 1.
hal::Result<ExportOutcome> export_recording(const ExportOptions& options,
                                            const std::function<void(double)>& progress);

void add_export_command(CLI::App& program, int& exit_status);

} // namespace octascope::firmware_host
