// An emission-line lamp on the spectrometer → wavelength over the pixel.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "hal/result.h"

namespace octascope::pipeline {

struct LampCalibration {
  std::vector<double> pixels;        // of the peaks, in fractions of a pixel
  std::vector<double> residuals_nm;  // line − λ(pixel)
  std::vector<double> polynomial_nm; // λ(p) = Σ a_i p^i
  double rms_nm = 0;
};

// The peaks are the highest ones of `spectrum`, as many as there are lines, placed by the centroid
// of what rises above the half of each; `lines_nm` are in the order of the pixels, rising or
// falling. The polynomial's degree is 3, less with fewer than 5 lines: one line more than it has
// terms shows how well they fit. ErrorCode::bad_data with `name` and index, found and expected: too
// few or ambiguous peaks, a line that is off by more than the mean width of a pixel, a wavelength
// that is not monotone. ErrorCode::invalid_argument for the lines.
hal::Result<LampCalibration> find_lamp_lines(std::span<const double> spectrum,
                                             std::span<const double> lines_nm,
                                             std::string_view name);

} // namespace octascope::pipeline
