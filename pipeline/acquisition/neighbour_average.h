// Speckle averaging of neighbouring B-scans, on the levels that are displayed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/result.h"

namespace octascope::pipeline {

struct NeighbourWeights {
  double before = 0.25;
  double here = 0.5;
  double after = 0.25;
};

// Averages the 8-bit counts, that is decibels, as the source paper does. Immutable: any thread.
class NeighbourAverage {
public:
  // ErrorCode::invalid_argument: a weight is negative or not finite, or `here` is 0.
  static hal::Result<NeighbourAverage> create(const NeighbourWeights& weights);

  // Averages a B-scan with its neighbours; all inputs are levels before any averaging. A neighbour
  // that does not exist or is missing is an empty span: the other weights are scaled to sum to 1.
  // Rounds to the nearest count. `result` must not overlap an input. Allocates nothing.
  void average(std::span<const std::uint8_t> before, std::span<const std::uint8_t> here,
               std::span<const std::uint8_t> after, std::span<std::uint8_t> result) const noexcept;

private:
  // 16-bit fixed point, summing to 65536, for one combination of present neighbours.
  struct FixedWeights {
    std::uint32_t before = 0;
    std::uint32_t here = 0;
    std::uint32_t after = 0;
  };

  explicit NeighbourAverage(const NeighbourWeights& weights);

  std::array<FixedWeights, 4> weights_; // index: bit 0, has one before; bit 1, has one after
};

} // namespace octascope::pipeline
