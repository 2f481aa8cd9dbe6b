// The axial point spread function of a mirror: its finely sampled depth profile and peak width.
#pragma once

#include <span>
#include <vector>

#include "pipeline/calibration/calibration.h"

namespace octascope::pipeline {

inline constexpr std::size_t psf_steps_per_bin = 16;

struct AxialPsf {
  std::vector<double> magnitude; // |Y|/N of the zero-padded transform, up to N/2 bins
  double peak_bin = 0;           // in bins of the transform of N
  double fwhm_bins = 0;          // of |Y|, between the outermost half-maximum crossings
  double level_db = 0;           // 20·log10 of the peak
};

// Processes one line with `calibration` (positions, interpolation, window, phases times
// `theta_sign`; no background), followed by a zero-padded transform. The peak is searched from
// lowest_fringe_bin (fringe.h) on, beyond the residual background.
AxialPsf measure_axial_psf(std::span<const double> line, const Calibration& calibration,
                           double theta_sign = 1);

// x[m] = s(r[m]): one line resampled to positions uniform in k.
std::vector<double> resample_line(std::span<const double> line, const ResamplingTaps& taps);

} // namespace octascope::pipeline
