// How far a ray can leap from a brick: the distance to the nearest bricks that are not empty.
//
// One number per brick: its highest level in the upper 8 bits, the distance in the lower 8 bits (0
// for bricks that are not empty). Both classes allocate when the number of bricks changes.
#pragma once

#include <cstdint>
#include <vector>

#include "pipeline/threads/work_team.h"
#include "pipeline/volume/occupancy.h"
#include "ui/bricks/brick_grid.h"

namespace octascope::ui {

// For rays of any direction: the Chebyshev distance to the nearest brick that is not empty, in
// bricks, at most `most`. In the order [b][a][depth].
class DistancesAround {
public:
  static constexpr int most = 10;

  // Shared among the team.
  void measure(const BrickGrid& grid, WorkTeam* team = nullptr);
  const std::uint16_t* data() const { return numbers_.data(); }

private:
  void spread_slabs(std::size_t b, std::size_t slab, std::size_t slabs);

  std::vector<std::uint16_t> numbers_;
  std::vector<std::uint8_t> distance_; // by turns, as one axis after the other is looked along
  std::vector<std::uint8_t> within_;
};

// For rays grouped by octant of directions: the edge, in bricks, of the largest cube of empty
// bricks that starts with this brick and extends forwards, at most `most`; everything outside the
// volume counts as empty. A ray that leaves a surface gets a long distance at once; with one
// distance for all directions it would take many short leaps.
//
// Bits of the octant's index, set for rays that ascend: depth (0), fast axis (1), slow axis (2).
class DistancesAhead {
public:
  static constexpr int octants = 8;
  static constexpr int most = 255;

  // To be called when the grid has changed.
  void forget() { measured_ = 0; }

  // Computes the octants with a bit in `wanted` that are not known yet, shared among the team.
  void measure(const BrickGrid& grid, unsigned wanted, WorkTeam* team = nullptr);

  // In the order [octant][b][a][depth]; octants that were never wanted are undefined.
  const std::uint16_t* data() const { return numbers_.data(); }

private:
  void measure_octant(const BrickGrid& grid, unsigned octant);

  std::vector<std::uint16_t> numbers_; // with one element of padding: kernels load two at a time
  std::vector<std::uint8_t> distance_; // [octant][b][a][depth]
  std::vector<std::uint8_t> line_;     // [octant][depth]
  unsigned measured_ = 0;
};

} // namespace octascope::ui
