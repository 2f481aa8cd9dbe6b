// k-linearisation: the pixel positions of samples uniform in wavenumber, and the interpolation of
// counts between pixels.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "hal/result.h"

namespace octascope::pipeline {

enum class Interpolation : std::uint8_t {
  linear,
  cubic, // Catmull-Rom, 4 taps
  sinc8, // 8 taps, Kaiser window with beta 4
};

// r(m) = Σ c_i (m/(N−1))^i, also used for the dispersion phase.
std::vector<double> evaluate_unit_polynomial(std::span<const double> coefficients, int samples);

// Fractional pixel positions uniform in k = 2π/λ between the ends of λ(p) = Σ a_i p^i (nm), found
// by bisection. ErrorCode::bad_data, with the pixel named, where λ is not positive or not strictly
// monotone.
hal::Result<std::vector<double>> positions_from_wavelength(std::span<const double> coefficients_nm,
                                                           int samples);

// Turns a table of wavenumbers by pixel, in any unit and strictly monotone, into the pixel
// positions at which the wavenumbers are uniform. Between pixels the curve is taken as linear, an
// error below 1e-4 pixels if steps change by no more than 1e-3 of their size.
std::vector<double> invert_curve(std::span<const double> curve);

// The greatest difference, in pixels, between these positions and those that the same curve would
// give if it were wavenumbers by pixel.
double distance_the_other_way_round(std::span<const double> positions);

// Describes what is wrong with a curve of positions, naming index and values: not finite, not
// strictly monotone (rising or falling), or mostly outside the line. Empty if it is good.
std::optional<std::string> find_position_fault(std::span<const double> positions);

// Describes the first step that differs greatly from its neighbours; empty if there is none.
// Measured curves have such steps where a phase was unwrapped wrongly (1201.42 → 1210.44 in a real
// one). The curve must have passed find_position_fault().
std::optional<std::string> find_position_jump(std::span<const double> positions);

// Interpolation as a sum over taps: x[m] = Σ_t weights[m·width + t] · s[first[m] + t]. Windows
// that would extend past an end are moved inside, and the weights of the pixels beyond the end are
// added to the end pixel's, which is the same as repeating that pixel: no tap is outside the line.
struct ResamplingTaps {
  int width = 0;                   // 4 or 8; 0: every position is its own pixel, no resampling
  std::vector<std::int32_t> first; // padded to a multiple of 4, with weights of 0
  std::vector<float> weights;
};

// `positions` lie in [0, N−1], N ≥ 16.
ResamplingTaps make_resampling_taps(std::span<const double> positions, Interpolation interpolation);

} // namespace octascope::pipeline
