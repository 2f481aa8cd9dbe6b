// Writes a calibration that was found, as the file that every command accepts.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hal/result.h"
#include "pipeline/calibration/calibration.h"

namespace octascope::pipeline {

// Where a calibration came from, for human readers: [provenance] in the file.
struct Provenance {
  std::string program; // and its version
  std::string method;
  std::string inputs;  // description of the input files
  std::string created; // date and time
  std::string verdict; // the quality figures in one line
};

struct FoundCalibration {
  Calibration calibration; // positions and dispersion go to curve files beside the TOML
  std::vector<double> wavelength_polynomial_nm;  // if not empty, written instead of positions
  std::vector<double> dispersion_polynomial_rad; // if not empty, written instead of phases
  bool spacing_known = false;                    // if not, [depth] has its spacing as a comment
  Provenance provenance;
};

// The curve files that write_calibration() may write with `file`.
std::vector<std::filesystem::path> curves_beside(const std::filesystem::path& file);

// Writes `file` (TOML) and, where needed, beside it <stem>_k_linear.txt and
// <stem>_dispersion_rad.txt (17 digits), <stem>_background_f32.raw and <stem>_source_f32.raw (dark
// counts subtracted). All are completely written under temporary names before the first is renamed;
// the TOML is renamed last. Calibration::load() gives the same calibration back. Errors: those of
// AtomicFile, and ErrorCode::invalid_argument if `file` has the name of one of the curves.
hal::Result<> write_calibration(const FoundCalibration& found, const std::filesystem::path& file);

} // namespace octascope::pipeline
