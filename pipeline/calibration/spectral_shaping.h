// Shapes the spectrum to a Gaussian, whatever the spectrum of the light source.
//
// A source with ripple or humps gives every reflector side lobes that no window removes, because
// the window only multiplies the source spectrum S. If S was recorded, the factors G[m] / S(r[m])
// turn it into the Gaussian G, whose transform has no side lobes. After R. Tripathi,
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

  // The source's spectrum by pixel, dark counts subtracted, in any unit.
  std::vector<float> source;
  // Full width at half maximum of the Gaussian, as a fraction of the line. Narrower: lower side
  // lobes, and the weak edges of the source matter less; wider: a sharper axial point spread.
  double fwhm = 0.4;
  // Limits the gain: a source weaker than its maximum by more than this factor is treated as weaker
  // by just this factor. Otherwise the noise of pixels without light would be amplified without
  // bound.
  double highest_gain = 10;
};

// One factor for each sample uniform in k, to be used instead of a window. The Gaussian is centred
// on the source's centroid and scaled so that a reflector is as bright as with the Hann window. The
// source is interpolated like the lines. ErrorCode::bad_data, with found and expected: the source
// has no light, a value that is not finite or the wrong length. ErrorCode::invalid_argument: a
// parameter is out of range.
hal::Result<std::vector<double>> make_shaping_factors(const SourceShaping& shaping,
                                                      std::span<const double> positions,
                                                      Interpolation interpolation);

} // namespace octascope::pipeline
