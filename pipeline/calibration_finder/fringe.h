// The fringe of one mirror over the spectrometer's pixels: its phase and amplitude.
//
// First, the band around the fringe's peak in the transform gives an analytic signal. Its phase is
// unwrapped outwards from the brightest pixel and smoothed. Then, several times, the spectrum
// around each pixel is fitted with c + a·cos φ + b·sin φ (Gaussian weights a few fringes wide), and
// the angle of (a, −b) corrects φ. The fit includes the constant and the mirrored frequency, so
// neither the background nor the ends of the line distort the phase.
#pragma once

#include <span>
#include <string_view>
#include <vector>

#include "hal/result.h"
#include "pipeline/calibration_finder/smooth_curve.h"

namespace octascope::pipeline {

// The minimum line length from which a curve can be found.
inline constexpr std::size_t fewest_fringe_samples = 64;
// Nearer to zero delay (in bins) a fringe cannot be distinguished from the background.
inline constexpr std::size_t lowest_fringe_bin = 6;

struct Fringe {
  SmoothCurve phase_rad;            // as a function of pixel, rising
  std::vector<double> measured_rad; // of each pixel before smoothing; valid where bright
  std::vector<double> amplitude;    // of each pixel, in the spectrum's unit
  std::size_t first_bright = 0;     // pixels from here …
  std::size_t last_bright = 0;      // … to here are bright enough to be used
  double noise = 0;                 // rms of the spectrum not explained by the fringe
  double residual_rad = 0;          // weighted rms of the phase about the smooth curve
};

// `spectrum` is one line, preferably without its background. ErrorCode::bad_data, with `name`,
// index, found and expected: not finite, too short, constant, no clear fringe.
hal::Result<Fringe> find_fringe(std::span<const double> spectrum, std::string_view name);

// The spectrum minus its Gaussian moving average. This removes whatever has fewer than about five
// periods over the line: the background, if none was measured.
std::vector<double> remove_slow_part(std::span<const double> spectrum);

} // namespace octascope::pipeline
