// Finds wavelength as a function of pixel from the spectrum of an emission-line lamp.
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

// Uses the highest peaks of `spectrum`, as many as there are lines, each located by the centroid of
// the part above half its height. `lines_nm` are in pixel order, rising or falling. The degree of
// the polynomial is 3, or less with fewer than 5 lines: there is always one more line than terms to
// show the quality of the fit. ErrorCode::bad_data, with `name`, index, found and expected: too few
// or ambiguous peaks, a line off by more than the mean width of a pixel, a wavelength that is not
// monotone. ErrorCode::invalid_argument: `lines_nm` are too few, not positive or not in order.
hal::Result<LampCalibration> find_lamp_lines(std::span<const double> spectrum,
                                             std::span<const double> lines_nm,
                                             std::string_view name);

} // namespace octascope::pipeline
