// The calibration of one spectrometer: positions uniform in wavenumber, dispersion phase,
// background, spectral window and the physical spacings.
//
// The file is TOML, with paths relative to it; the format is described in docs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "hal/result.h"
#include "pipeline/calibration/fixed_pattern.h"
#include "pipeline/calibration/k_linearisation.h"
#include "pipeline/calibration/spectral_shaping.h"
#include "pipeline/calibration/spectral_window.h"
#include "pipeline/volume/volume_geometry.h"

namespace octascope::pipeline {

enum class BackgroundMode : std::uint8_t {
  mean,    // of the kept lines of each B-scan
  running, // mean over the volumes before (background.h)
  file,    // a recorded spectrum
  none,
};

// What the values of [k_linear] table are.
enum class KTable : std::uint8_t {
  none,       // there is no table
  unsaid,     // taken for pixels
  pixel,      // by wavenumber
  wavenumber, // by pixel
};

// Limits for the samples of a line.
inline constexpr int fewest_samples = 16;
inline constexpr int most_samples = 65536;

// A plain value. All curves are resolved to `samples` values in double precision.
struct Calibration {
  int samples = 1024;
  std::string camera; // hal::LineCamera::identity() of the camera it was made with; empty: unknown
  std::vector<double> positions; // r[m], fractional pixels in [0, samples−1], uniform in k
  KTable k_table = KTable::none; // where the positions came from
  Interpolation interpolation = Interpolation::sinc8;
  std::vector<double> dispersion_rad; // θ[m], sign included; empty: none
  BackgroundMode background_mode = BackgroundMode::running;
  std::vector<float> background; // counts after the right shift; only for BackgroundMode::file
  FixedPatternRemoval fixed_pattern;
  // w[m]: the factors that are applied. Their origin, for the file, is `shaping` if set, else
  // `window_kind`.
  std::vector<double> window;
  SpectralWindow window_kind = SpectralWindow::hann;
  std::optional<SourceShaping> shaping;
  int zero_padding = 1;          // 1: none; 2: each line is followed by as many zeros as samples
  double depth_spacing_um = 3.5; // of one bin without zero padding, in the medium
  std::optional<double> refractive_index; // of that medium: 1 is air; empty: unknown
  double a_spacing_um = 10;
  double b_spacing_um = 37.5;
  AssumedSpacings assumed_spacings{true, true, true}; // those that the file does not give

  // The whole file, or an Error that names file, line or index, what was found and what was
  // expected. `expected_samples`: samples per line of the spectra.
  static hal::Result<Calibration> load(const std::filesystem::path& file, int expected_samples);

  // Used when no calibration is given: no resampling, no dispersion, Hann window, a running
  // background.
  static Calibration identity(int samples);

  // The number of depth bins of an A-scan, and their spacing.
  int depths() const { return samples * zero_padding / 2; }
  double bin_spacing_um() const { return depth_spacing_um / zero_padding; }

  // Every curve has `samples` finite values and every position lies on the line.
  hal::Result<> validate() const;
};

// A warning if the table does not say which way round it is and the two readings differ; else
// nothing. `file` is the calibration's.
std::optional<std::string> doubt_about_k_table(const Calibration& calibration,
                                               const std::filesystem::path& file);

// The camera that a calibration names; empty: none. Reads and checks nothing else in it.
hal::Result<std::string> calibration_camera(const std::filesystem::path& file);

class ConfigDocument;

// The file as a document whose named_files() are all files that the calibration uses, so that it
// can be copied together with them (ConfigDocument::text_naming()). Checks nothing else.
hal::Result<ConfigDocument> calibration_document(const std::filesystem::path& file);

} // namespace octascope::pipeline
