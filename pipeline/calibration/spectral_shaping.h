// Shaping of the spectrum to a Gaussian, whatever the light source looks like.
//
// A source with ripple or humps gives every reflector side lobes that no window takes away, because
// the window multiplies the source's own shape. Where the source was recorded, the factors
// G[m] / S(r[m]) make its spectrum the Gaussian G, whose transform has none. After R. Tripathi,
// N. Nassif, J. S. Nelson, B. H. Park, J. F. de Boer: Spectral shaping for non-Gaussian source
// spectra in optical coherence tomography, Optics Letters 27 (2002) 406.
#pragma once

#include <span>
#include <vector>

#include "hal/result.h"
#include "pipeline/calibration/k_linearisation.h"

namespace octascope::pipeline {

struct SourceShaping {
  static constexpr double narrowest_fwhm = 0.05;
  static constexpr double widest_fwhm = 2;
  static constexpr double most_gain = 1000;

  // The source's spectrum by pixel, the dark counts taken off, in any unit.
  std::vector<float> source;
  // Full width at half maximum of the Gaussian, as a share of the line. Narrower: fewer side
  // lobes and less of the source's edges needed; wider: a sharper axial point spread.
  double fwhm = 0.4;
  // A source weaker than its maximum by more than this factor is taken to be no weaker: what has
  // no light has noise, and would be amplified without bound.
  double highest_gain = 10;
};

// One factor for each of the samples uniform in k, in place of a window's: with the source's
// centroid as the Gaussian's centre, and scaled so that a reflector is as bright as it is with the
// Hann window. The source is interpolated as the lines are. ErrorCode::bad_data with found and
// expected for a source without light, ErrorCode::invalid_argument for figures out of range.
hal::Result<std::vector<double>> make_shaping_factors(const SourceShaping& shaping,
                                                      std::span<const double> positions,
                                                      Interpolation interpolation);

} // namespace octascope::pipeline
