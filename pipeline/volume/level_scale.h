// Levels in decibels and as the 8-bit counts that volumes are stored in.
//
// A level is 20·log10(|Y|/N) for raw camera counts. The range is wide and fixed, so that a count
// means the same level for ever: half a decibel a count from the noise of an 8-bit camera (−40 dB)
// to a full-scale reflector on a 16-bit one (about 78 dB). What is bright on the screen is decided
// later, by the display's window, which acts on these counts.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace octascope::pipeline {

inline constexpr float lowest_level_db = -40.0F;
inline constexpr float level_step_db = 0.5F;
inline constexpr float highest_level_db = lowest_level_db + 255 * level_step_db;

constexpr float level_db(float count) {
  return lowest_level_db + count * level_step_db;
}
constexpr float level_count(float db) {
  return (db - lowest_level_db) / level_step_db;
}

inline std::uint8_t quantise_level(float db) {
  return static_cast<std::uint8_t>(std::lround(std::clamp(level_count(db), 0.0F, 255.0F)));
}

} // namespace octascope::pipeline
