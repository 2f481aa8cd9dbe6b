// Speckle averaging of neighbouring B-scans, on the levels that are displayed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/result.h"
#include "pipeline/volume.h"

namespace octascope::pipeline {

struct NeighbourWeights {
  double before = 0.25;
  double here = 0.5;
  double after = 0.25;
};

// Works in place, with scratch of a few kilobytes inside the object: one thread at a time. Averages
// the 8-bit counts, so decibels, as the source paper does.
class NeighbourAverage {
public:
  // Fault::invalid_argument: a weight is negative or not finite, or `here` is 0.
  static hal::Result<NeighbourAverage> create(const NeighbourWeights& weights);

  // At the first and last B-scan, and beside a missing one, the weights that exist are scaled to
  // sum to 1. Missing B-scans stay as they are. Rounds to the nearest count. Allocates nothing.
  void apply(Volume& volume) noexcept {
    apply(volume.levels, volume.b_scan_states, volume.geometry.b_scan_voxels());
  }
  // `levels` in the order [b][voxel].
  void apply(std::span<std::uint8_t> levels, std::span<const BScanState> states,
             std::size_t b_scan_voxels) noexcept;

private:
  // 16-bit fixed point that sums to 65536, for each pattern of neighbours that exist.
  struct FixedWeights {
    std::uint32_t before = 0;
    std::uint32_t here = 0;
    std::uint32_t after = 0;
  };
  static constexpr std::size_t chunk = 4096;

  explicit NeighbourAverage(const NeighbourWeights& weights);

  std::array<FixedWeights, 4> weights_; // index: 1 has one before, 2 has one after
  // What a piece of this B-scan, and of the one before it, was before it was averaged.
  std::array<std::array<std::uint8_t, chunk>, 2> originals_{};
};

} // namespace octascope::pipeline
