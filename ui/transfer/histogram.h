// How often each level occurs in a volume.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "pipeline/volume/volume.h"

namespace octascope::ui {

// Counts of the 256 levels (pipeline/volume/level_scale.h has their decibels).
struct LevelHistogram {
  std::array<std::uint32_t, 256> counts{};

  // For drawing: 128 bars of one decibel each from lowest_level_db on, 1 for the highest. A bar's
  // height is the square root of its count, so that the few bright voxels are visible beside the
  // noise. Level 0, where nothing was measured, is left out. All 0 for an empty histogram.
  static constexpr std::size_t bars = 128;
  std::array<float, bars> shares() const;
};

// Counts A-scans spread evenly over the volume, at most about half a million voxels: takes less
// than a millisecond and is deterministic. Leaves out missing B-scans and the first two depth bins,
// which hold residual background. Pure.
LevelHistogram make_level_histogram(const pipeline::Volume& volume);

} // namespace octascope::ui
