// Finds the positions uniform in k and the dispersion from two mirrors at unequal depths.
//
// The phases of the two fringes are φ₁ = a₁·k + b₁ − θ and φ₂ = a₂·k + b₂ − θ: their difference is
// linear in k whatever the dispersion θ. It gives k up to an offset and a scale; both are chosen so
// that the first and last pixel of the line become the first and last sample, and the depth spacing
// refers to that scale. θ is the residual of −φ over k from a straight line. The constant and slope
// of θ cannot be distinguished from depth; they are removed over the bright pixels.
//
// If zero delay lies between the mirrors, θ has the opposite sign in one fringe, and the sum of the
// phases is linear in k. The pair alone does not show which case it is: the caller must say, or try
// the possibilities on tissue (tissue_sharpness.h).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "hal/result.h"
#include "pipeline/calibration_finder/fringe.h"

namespace octascope::pipeline {

// Which mirrors lie on the same side of zero delay as samples do.
enum class SampleSide : std::uint8_t { both_mirrors, first_mirror, second_mirror, no_mirror };

struct MirrorPair {
  std::array<Fringe, 2> fringes;
  std::array<double, 2> depth_bins;   // of the linearised axis
  std::array<double, 2> theta_sign;   // of each mirror's fringe, relative to `dispersion_rad`
  std::vector<double> positions;      // r[m]
  std::vector<double> dispersion_rad; // θ[m], multiplies as exp(+iθ)
};

// `first` and `second` are one line each, of equal length, in any order of depth, preferably
// without background. ErrorCode::bad_data: as find_fringe(); depths that are too close; positions
// that do not rise, or that jump, with the index.
hal::Result<MirrorPair> find_mirror_pair(std::span<const double> first,
                                         std::span<const double> second,
                                         SampleSide side = SampleSide::both_mirrors);

// The same, from fringes that have already been found.
hal::Result<MirrorPair> combine_fringes(const std::array<Fringe, 2>& fringes, SampleSide side);

} // namespace octascope::pipeline
