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

  // For drawing: 128 bars, a decibel each from lowest_level_db on, 1 for the highest. The share of
  // a bar is the square root of its count's, so that the few bright voxels can be seen beside the
  // noise. Level 0, where nothing was measured, is left out. All 0 for an empty histogram.
  static constexpr std::size_t bars = 128;
  std::array<float, bars> shares() const;
};

// Of A-scans spread evenly over the volume, at most about half a million voxels: less than a
// millisecond, and the same for the same volume. Leaves out missing B-scans and the first two depth
// bins, which hold what the background left behind. Pure.
LevelHistogram make_level_histogram(const pipeline::Volume& volume);

} // namespace octascope::ui
