// The fringe of one mirror on the pixels of the spectrometer: its phase and its strength.
//
// First the band around the fringe's peak in the transform gives an analytic signal, whose phase is
// unwrapped from its brightest pixel outwards and smoothed. Then, a few times, the spectrum around
// each pixel is fitted with c + a·cos φ + b·sin φ (Gaussian weights a few fringes wide): the angle
// of (a, −b) corrects φ. The constant and the mirrored frequency are part of the fit, so neither
// the background nor the ends of the line bend the phase.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "hal/result.h"
#include "pipeline/calibration_finder/smooth_curve.h"

namespace octascope::pipeline {

// The fewest samples of a line that a curve is found from.
inline constexpr std::size_t fewest_fringe_samples = 64;
// Nearer to zero delay (in bins) a fringe is not told from the background.
inline constexpr std::size_t lowest_fringe_bin = 6;

struct Fringe {
  SmoothCurve phase_rad;            // over the pixel, rising
  std::vector<double> measured_rad; // of each pixel before smoothing; meaningful where bright
  std::vector<double> amplitude;    // of each pixel, in the spectrum's unit
  std::size_t first_bright = 0;     // pixels from here …
  std::size_t last_bright = 0;      // … to here are strong enough to be believed
  double noise = 0;                 // rms of the spectrum that the fringe does not explain
  double residual_rad = 0;          // rms of the phase that the smooth curve leaves, weighted
};

// `spectrum` is one line, best without its background. ErrorCode::bad_data, with `name`, index,
// found and expected: not finite, too short, constant, without a clear fringe.
hal::Result<Fringe> find_fringe(std::span<const double> spectrum, std::string_view name);

// The spectrum less its Gaussian moving average: what makes fewer than about five fringes over the
// line, which is the background when none was measured, is gone.
std::vector<double> remove_slow_part(std::span<const double> spectrum);

} // namespace octascope::pipeline
