// k-linearisation: where on the spectrometer the samples lie that are uniform in wavenumber, and
// how the counts between its pixels are found.
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

// What is wrong with a curve of positions, naming the index and the values: not finite, not
// strictly monotone (rising or falling), or mostly outside the line. Nothing when it is good.
std::optional<std::string> find_position_fault(std::span<const double> positions);

// The first step that is far out of line with its neighbours: measured curves have them where a
// phase was unwrapped wrongly (1201.42 → 1210.44 in a real one). Expects a curve without the faults
// above.
std::optional<std::string> find_position_jump(std::span<const double> positions);

// Interpolation as a sum over taps: x[m] = Σ_t weights[m·width + t] · s[first[m] + t]. Windows that
// would reach over an end are moved inside, and the weights of the pixels beyond it are added to
// the last pixel's, which is the same as repeating that pixel: no tap ever leaves the line.
struct ResamplingTaps {
  int width = 0;                   // 4 or 8; 0 when every position is its own pixel: no resampling
  std::vector<std::int32_t> first; // a multiple of 4 of them; the padding has weights of 0
  std::vector<float> weights;
};

// `positions` lie in [0, N−1], N ≥ 16.
ResamplingTaps make_resampling_taps(std::span<const double> positions, Interpolation interpolation);

} // namespace octascope::pipeline
