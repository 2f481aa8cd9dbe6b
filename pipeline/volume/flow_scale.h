// What flows (docs/ANGIOGRAPHY.md), as the 8-bit counts that volumes are stored in.
//
// 0: it cannot be told, or nobody looked. 1 to 255: from static to flowing. What is not known lies
// beside what is static, so that interpolation never makes a vessel of it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace octascope::pipeline {

inline constexpr std::uint8_t flow_untold = 0;
inline constexpr std::uint8_t flow_static = 1;
inline constexpr std::uint8_t flow_full = 255;

// `flow`: 0 to 1, NaN where it cannot be told.
inline std::uint8_t quantise_flow(float flow) {
  if (std::isnan(flow))
    return flow_untold;
  return static_cast<std::uint8_t>(
      1 + static_cast<int>(std::lround(std::clamp(flow, 0.0F, 1.0F) * 254.0F)));
}

inline float flow_of(std::uint8_t count) {
  return count == flow_untold ? std::numeric_limits<float>::quiet_NaN()
                              : static_cast<float>(count - flow_static) / 254.0F;
}

} // namespace octascope::pipeline
