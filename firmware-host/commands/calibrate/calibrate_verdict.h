// How good a calibration is, in numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace octascope::firmware_host {

struct MirrorVerdict {
  std::string file;
  double depth_bins = 0; // from the slope of its phase over k
  double peak_bins = 0;  // where its peak is
  double fwhm_before_bins = 0;
  double fwhm_after_bins = 0;
  double level_before_db = 0;
  double level_after_db = 0;
  double residual_rad = 0; // rms of its phase about the smooth curve
  int first_bright_pixel = 0;
  int last_bright_pixel = 0;
};

struct LampVerdict {
  std::vector<double> lines_nm;
  std::vector<double> pixels;
  std::vector<double> residuals_nm;
  std::vector<double> polynomial_nm;
  double rms_nm = 0;
};

struct TissueVerdict {
  double sharpness_before = 0; // k-linear, no dispersion
  double sharpness_after = 0;
  std::vector<double> polynomial_rad; // of m/(N−1), when the tissue gave it
};

struct CalibrationVerdict {
  std::string method;
  std::string file; // that was written
  int samples = 0;
  std::optional<double> spacing_um;       // of a bin, when known
  std::optional<double> refractive_index; // in which that holds; empty: nobody said
  std::vector<MirrorVerdict> mirrors;
  std::string sample_side; // which mirrors lie where samples do
  std::string side_source; // how that is known
  std::optional<LampVerdict> lamp;
  std::optional<TissueVerdict> tissue;
  bool monotone = true;         // all others are refused
  double least_step_pixels = 0; // of r[m] from sample to sample
  double greatest_step_pixels = 0;
  double dispersion_rms_rad = 0;

  // Of a pair of mirrors.
  double residual_rad() const;        // of both, rms
  double depth_error_bins() const;    // the greatest distance of a peak from its phase's depth
  double roll_off_db_per_bin() const; // fall of the level from the shallow mirror to the deep one
};

// Some lines of plain text, or one JSON object.
std::string to_text(const CalibrationVerdict& verdict);
std::string to_json(const CalibrationVerdict& verdict);
// The most telling figures in one line.
std::string summary(const CalibrationVerdict& verdict);

} // namespace octascope::firmware_host
