// The verdict as a picture: spectra, phases, point spreads before and after.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "pipeline/calibration_finder/axial_psf.h"
#include "pipeline/calibration_finder/mirror_pair.h"
#include "pipeline/files/png_image.h"

namespace octascope::firmware_host {

struct MirrorMeasurement {
  std::vector<double> interferogram;
  pipeline::AxialPsf before;
  pipeline::AxialPsf after;
};

pipeline::Image draw_mirrors(const std::array<MirrorMeasurement, 2>& mirrors,
                             const pipeline::MirrorPair& pair);

// For a lamp or a tissue: the k curve's deviation from a straight line, and the dispersion.
pipeline::Image draw_curves(std::span<const double> positions,
                            std::span<const double> dispersion_rad);

} // namespace octascope::firmware_host
