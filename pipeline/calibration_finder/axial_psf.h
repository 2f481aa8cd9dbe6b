// The axial point spread of a mirror: its depth profile, fine, and the width of its peak.
#pragma once

#include <span>
#include <vector>

#include "pipeline/calibration/calibration.h"

namespace octascope::pipeline {

inline constexpr std::size_t psf_steps_per_bin = 16;

struct AxialPsf {
  std::vector<double> magnitude; // |Y|/N of the zero-padded transform, up to N/2 bins
  double peak_bin = 0;           // in bins of the transform of N
  double fwhm_bins = 0;          // of |Y|, from the first to the last time at half the peak
  double level_db = 0;           // 20·log10 of the peak
};

// The chain of `calibration` (positions, interpolation, window, phases times `theta_sign`; no
// background) on one line, followed by a transform that is padded with zeros. The peak is looked
// for beyond the bins of what is left of the background.
AxialPsf measure_axial_psf(std::span<const double> line, const Calibration& calibration,
                           double theta_sign = 1);

// x[m] = s(r[m]): one line on the positions that are uniform in k.
std::vector<double> resample_line(std::span<const double> line, const ResamplingTaps& taps);

} // namespace octascope::pipeline
