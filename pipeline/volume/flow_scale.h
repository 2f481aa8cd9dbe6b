// What flows (docs/ANGIOGRAPHY.md), as the 8-bit counts that volumes are stored in.
//
// 0: it cannot be told, or nobody looked. 1 to 255: from static to flowing. What is not known lies
// beside what is static, so that interpolation never makes a vessel of it.
#pragma once

#include <cstdint>
#include <limits>

namespace octascope::pipeline {

inline constexpr std::uint8_t flow_untold = 0;
inline constexpr std::uint8_t flow_static = 1;
inline constexpr std::uint8_t flow_full = 255;

// `flow`: 0 to 1, NaN where it cannot be told.
// Plain enough to be vectorised.
inline std::uint8_t quantise_flow(float flow) {
  const bool told = flow == flow;
  float clamped = told ? flow : 0.0F;
  clamped = clamped < 0.0F ? 0.0F : clamped;
  clamped = clamped > 1.0F ? 1.0F : clamped;
  const int count = flow_static + static_cast<int>(clamped * 254.0F + 0.5F);
  return static_cast<std::uint8_t>(told ? count : flow_untold);
}

inline float flow_of(std::uint8_t count) {
  return count == flow_untold ? std::numeric_limits<float>::quiet_NaN()
                              : static_cast<float>(count - flow_static) / 254.0F;
}

} // namespace octascope::pipeline
