// A calibration that was found, as the file that every command takes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "hal/result.h"
#include "pipeline/calibration/calibration.h"

namespace octascope::pipeline {

// Where a calibration came from, for people: [provenance] in the file.
struct Provenance {
  std::string program; // and its version
  std::string method;
  std::string inputs;  // the files, in words
  std::string created; // date and time
  std::string verdict; // the figures in one line
};

struct FoundCalibration {
  Calibration calibration; // positions and dispersion go to curve files beside the TOML
  std::vector<double> wavelength_polynomial_nm;  // when not empty, in place of the positions
  std::vector<double> dispersion_polynomial_rad; // when not empty, in place of the phases
  bool spacing_known = false;                    // else [depth] says that its spacing was assumed
  Provenance provenance;
};

// Writes `file` (TOML) and beside it, where they are needed, <stem>_k_linear.txt and
// <stem>_dispersion_rad.txt, with 17 digits, <stem>_background_f32.raw and <stem>_source_f32.raw
// (without its dark counts). All of them are complete under temporary names before the first gets
// its own, the TOML last. What Calibration::load() makes of it is the same calibration. Faults as
// AtomicFile's, and ErrorCode::invalid_argument for a name that is one of the curves'.
hal::Result<> write_calibration(const FoundCalibration& found, const std::filesystem::path& file);

} // namespace octascope::pipeline
