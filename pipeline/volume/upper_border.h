// Does tissue reach the upper border of a volume?
//
// A spectrum does not tell the two sides of zero delay apart: what lies above it is folded over and
// shown upside down, in the same bins as what lies below. Tissue that crosses zero delay has no gap
// there, so it lights the border up. An A-scan counts as lit when the first bins behind what the
// background leaves (bins 4 to 11) are
//   - clearly above the B-scan's own noise floor, the lower quartile of its blocks of eight bins,
//   and
//   - not far below the brightest block of the same A-scan: where tissue lies deeper, its tails and
//     the noise of a real spectrometer, which is higher at small depths, brighten the border, too.
// What is folded and leaves a gap at the border is not noticed.
#pragma once

#include <cstdint>
#include <span>

namespace octascope::pipeline {

struct BorderCount {
  int looked_at = 0; // A-scans: some sixty of a B-scan, evenly spread
  int lit = 0;       // of those, whose tissue reaches the border

  BorderCount& operator+=(const BorderCount& other) {
    looked_at += other.looked_at;
    lit += other.lit;
    return *this;
  }
};

// Decibels above the floor, and below the brightest, that make an A-scan lit; and the share of lit
// A-scans from which a volume has tissue at its border (docs/RECONSTRUCTION.md has the margins).
inline constexpr double lit_above_floor_db = 15;
inline constexpr double lit_below_brightest_db = 15;
inline constexpr double share_at_border = 0.05;

// `levels` [a][z] of one B-scan in counts (level_scale.h). Nothing is looked at where there are
// fewer than 48 depths. Any thread; allocates nothing, and reads one A-scan in four or fewer.
BorderCount count_at_upper_border(std::span<const std::uint8_t> levels, int depths,
                                  int a_scans) noexcept;

inline bool is_at_upper_border(const BorderCount& count) {
  return count.looked_at > 0 && count.lit >= share_at_border * count.looked_at;
}

} // namespace octascope::pipeline
