// Two mirrors at unequal depths → the positions that are uniform in k, and the dispersion.
//
// The phases of the two fringes are φ₁ = a₁·k + b₁ − θ and φ₂ = a₂·k + b₂ − θ: their difference is
// linear in k whatever the dispersion θ. It is scaled so that the first and the last pixel of the
// line are the first and the last sample: a pair of mirrors gives k up to its ends (an offset and a
// scale), and the depth spacing belongs to that scale. What a straight line leaves of −φ over k is
// θ; constant and slope of θ cannot be told from depth, and are taken out over the bright pixels.
//
// When zero delay lies between the mirrors, one fringe has the opposite sign of θ, and the sum of
// the phases is linear in k. The pair alone cannot tell which it was: the caller says, or tries
// the possibilities on a tissue (tissue_sharpness.h).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/result.h"
#include "pipeline/calibration_finder/fringe.h"

namespace octascope::pipeline {

// Which mirrors lie on the side of zero delay where samples lie.
enum class SampleSide : std::uint8_t { both_mirrors, first_mirror, second_mirror, no_mirror };

struct MirrorPair {
  std::array<Fringe, 2> fringes;
  std::array<double, 2> depth_bins;   // of the linearised axis
  std::array<double, 2> theta_sign;   // of each mirror's fringe against `dispersion_rad`
  std::vector<double> positions;      // r[m]
  std::vector<double> dispersion_rad; // θ[m], multiplies as exp(+iθ)
};

// `spectra` are one line each, of equal length, best without their background, in any order of
// depth. ErrorCode::bad_data as find_fringe(), and for depths that are too close, and for positions
// that do not rise, with the index.
hal::Result<MirrorPair> find_mirror_pair(std::span<const double> first,
                                         std::span<const double> second,
                                         SampleSide side = SampleSide::both_mirrors);

// The same from fringes that were found before.
hal::Result<MirrorPair> combine_fringes(const std::array<Fringe, 2>& fringes, SampleSide side);

} // namespace octascope::pipeline
