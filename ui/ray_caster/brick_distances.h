// How far a ray can leap from a brick: the distance to non-empty bricks.
//
// One number a brick: its highest level in the upper 8 bits, below it the distance, 0 for non-empty
// bricks. Both classes allocate when the number of bricks changes.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/volume/occupancy.h"
#include "ui/ray_caster/brick_grid.h"

namespace octascope::ui {

// For rays of any direction: the Chebyshev distance to the nearest non-empty brick, in bricks, at
// most `most`. In the order [b][a][depth].
class DistancesAround {
public:
  static constexpr int most = 10;

  void measure(const BrickGrid& grid);
  const std::uint16_t* data() const { return numbers_.data(); }

private:
  bool grow_reach(const pipeline::BrickCounts& counts);

  std::vector<std::uint16_t> numbers_;
  std::vector<std::uint8_t> distance_;
  std::vector<std::uint8_t> reach_; // 1 within the distance reached so far
  std::vector<std::uint8_t> next_;
};

// For rays of one octant of directions (up or down each axis): the edge of the largest cube of
// empty bricks that begins with this one and lies ahead, in bricks, at most `most`; outside the
// volume all is empty. A ray that leaves a surface gets a long distance at once, where a distance
// for all directions would need many short leaps.
//
// Octant o holds the rays that go up depth (bit 0), the fast axis (bit 1), the slow one (bit 2).
class DistancesAhead {
public:
  static constexpr int octants = 8;
  static constexpr int most = 255;

  // Call when the grid has changed.
  void forget() { measured_ = 0; }

  // Computes the octants with a bit in `wanted` that are not known yet.
  void measure(const BrickGrid& grid, unsigned wanted);

  // In the order [octant][b][a][depth]; octants that were not wanted are undefined.
  const std::uint16_t* data() const { return numbers_.data(); }

private:
  void measure_octant(const BrickGrid& grid, unsigned octant);

  std::vector<std::uint16_t> numbers_; // one more than needed: kernels load two at a time
  std::vector<std::uint8_t> distance_; // of one octant
  std::vector<std::uint8_t> line_;
  unsigned measured_ = 0;
};

} // namespace octascope::ui
