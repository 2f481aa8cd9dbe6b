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
  std::vector<double> polynomial_rad; // of m/(N−1), if found from the tissue
};

// Which way round the given calibration's table of the k curve was taken.
struct TableVerdict {
  std::string gives;          // pixel or wavenumber
  std::string source;         // how that is known
  double sharpness = 0;       // of the tissue, each with the dispersion that suits it
  double other_sharpness = 0; // the other way round
  std::string warning;        // empty: none
};

struct CalibrationVerdict {
  std::string method;
  std::string file; // that was written
  int samples = 0;
  std::optional<double> spacing_um;       // per bin, if known
  std::optional<double> refractive_index; // for which the spacing holds; empty: unknown
  std::vector<MirrorVerdict> mirrors;
  std::string sample_side; // which mirrors lie on the samples' side
  std::string side_source; // how that was determined
  std::optional<LampVerdict> lamp;
  std::optional<TissueVerdict> tissue;
  std::optional<TableVerdict> table; // where it matters
  bool monotone = true;              // all others are refused
  double least_step_pixels = 0;      // smallest increase of r[m] from sample to sample
  double greatest_step_pixels = 0;
  double dispersion_rms_rad = 0;

  // For a pair of mirrors.
  double residual_rad() const;        // of both, rms
  double depth_error_bins() const;    // largest distance of a peak from the depth given by its
                                      // phase
  double roll_off_db_per_bin() const; // fall of level from the shallow mirror to the deep one
};

// A few lines of plain text, or one JSON object.
std::string to_text(const CalibrationVerdict& verdict);
std::string to_json(const CalibrationVerdict& verdict);
// The most important figures in one line.
std::string summary(const CalibrationVerdict& verdict);

} // namespace octascope::firmware_host
