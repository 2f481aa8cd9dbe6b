// Levels without the library's logarithm, which alone costs six times the Fourier transform.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "pipeline/volume/level_scale.h"

namespace octascope::pipeline {

inline constexpr float log2_c0 = 0.43872572F;
inline constexpr float log2_c1 = -0.23905812F;
inline constexpr float log2_c2 = 0.08213058F;
inline constexpr float db_per_octave_of_power = 3.01029996F;

// log2 of a positive, finite, normal float: the exponent as it stands, and for the mantissa m a
// polynomial of degree 4 in t = m − 1, exact at both ends so that the result is continuous:
// log2(1+t) ≈ t + t(1−t)(c0 + c1·t + c2·t²), minimax over [0, 1] with an error below 1.2e-4.
// Zero and subnormal numbers give about −127, not −infinity. Plain enough to be vectorised.
inline float fast_log2(float x) {
  const auto bits = std::bit_cast<std::int32_t>(x);
  const auto exponent = static_cast<float>((bits >> 23) - 127);
  const float t = std::bit_cast<float>((bits & 0x007F'FFFF) | 0x3F80'0000) - 1.0F;
  const float q = log2_c0 + t * (log2_c1 + t * log2_c2);
  return exponent + (t + t * (1.0F - t) * q);
}

// The same as a sum: log2 of a positive normal float x is its bits, taken for an integer, over
// 2^23, plus the polynomial with these coefficients (constant first) in the mantissa m = 1 … 2.
// They are the one above, expanded, less m − 1 and the exponent's bias.
constexpr std::array<float, 5> expand_log2_of_mantissa() {
  // t(1 − t)(c0 + c1·t + c2·t²) = Σ a_i·t^i, with t = m − 1
  constexpr double c0 = log2_c0;
  constexpr double c1 = log2_c1;
  constexpr double c2 = log2_c2;
  constexpr std::array<double, 5> a{0, c0, c1 - c0, c2 - c1, -c2};
  return {static_cast<float>(a[0] - a[1] + a[2] - a[3] + a[4] - 127),
          static_cast<float>(a[1] - 2 * a[2] + 3 * a[3] - 4 * a[4]),
          static_cast<float>(a[2] - 3 * a[3] + 6 * a[4]), static_cast<float>(a[3] - 4 * a[4]),
          static_cast<float>(a[4])};
}
inline constexpr std::array<float, 5> log2_of_mantissa = expand_log2_of_mantissa();

// 10·log10(power) within 0.002 dB (0.0004 dB in exact arithmetic).
inline float fast_power_db(float power) {
  return db_per_octave_of_power * fast_log2(power);
}

// As quantise_level(), for levels within ±10 000 dB; rounds a half upwards as well.
inline std::uint8_t fast_quantise_level(float db) {
  float count = level_count(db) + 0.5F;
  count = count < 0.0F ? 0.0F : count;
  count = count > 255.0F ? 255.0F : count;
  return static_cast<std::uint8_t>(static_cast<std::int32_t>(count));
}

} // namespace octascope::pipeline
