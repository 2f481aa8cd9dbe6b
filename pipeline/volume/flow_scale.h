// What flows (docs/ANGIOGRAPHY.md), as the 8-bit counts that volumes are stored in.
//
// 0: it cannot be told, or nobody looked. 1 to 255: from static to flowing. What is not known lies
// beside what is static, so that interpolation never makes a vessel of it.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

namespace octascope::pipeline {

inline constexpr std::uint8_t flow_untold = 0;
inline constexpr std::uint8_t flow_static = 1;
inline constexpr std::uint8_t flow_full = 255;

// `flow`: 0 to 1, NaN where it cannot be told.
// By the order of the bits, which is that of floats: comparisons of floats, which may signal, keep
// compilers from vectorising this below AVX-512.
inline std::uint8_t quantise_flow(float flow) {
  constexpr auto one = std::bit_cast<std::int32_t>(1.0F);
  constexpr auto first_nan =
      std::bit_cast<std::int32_t>(std::numeric_limits<float>::infinity()) + 1;
  const auto bits = std::bit_cast<std::int32_t>(flow);
  std::int32_t clamped = bits > 0 ? bits : 0;
  clamped = clamped < one ? clamped : std::int32_t{one}; // an address of either would be a branch
  const int count = flow_static + static_cast<int>(std::bit_cast<float>(clamped) * 254.0F + 0.5F);
  const std::int32_t told = ((bits & 0x7FFF'FFFF) - first_nan) >> 31; // all ones or zeros
  static_assert(flow_untold == 0);
  return static_cast<std::uint8_t>(count & told);
}

inline float flow_of(std::uint8_t count) {
  return count == flow_untold ? std::numeric_limits<float>::quiet_NaN()
                              : static_cast<float>(count - flow_static) / 254.0F;
}

} // namespace octascope::pipeline
