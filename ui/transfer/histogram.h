// The histogram of a volume's levels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "pipeline/volume/volume.h"

namespace octascope::ui {

// Counts of the 256 levels (in decibels: see pipeline/volume/level_scale.h).
struct LevelHistogram {
  std::array<std::uint32_t, 256> counts{};

  // For drawing: 128 bars of one decibel each, from lowest_level_db on; the highest is 1. Bar
  // heights are square roots of counts, so that the few bright voxels remain visible beside the
  // noise. Level 0 (nothing measured) is left out. All 0 for an empty histogram.
  static constexpr std::size_t bars = 128;
  std::array<float, bars> shares() const;
};

// From A-scans spread evenly over the volume, at most about half a million voxels: deterministic,
// in less than a millisecond. Leaves out missing B-scans and the first two depth bins, which hold
// residual background. Pure.
LevelHistogram make_level_histogram(const pipeline::Volume& volume);

} // namespace octascope::ui
