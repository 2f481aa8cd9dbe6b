// The highest and lowest level in each brick of a volume, built as B-scans arrive, so that a
// renderer can skip bricks that its window makes empty.
//
// Interpolation happens in cells, the spaces between voxels, so bricks are made of cells, and a
// brick's levels are those of every voxel that touches one of its cells: an interpolated level
// never leaves its brick's range. Cells along depth: cell i lies between depth bins i and i+1.
// Along the other two axes there is one more at either border, which repeats the border's voxel:
// cell i lies between voxels i−1 and i.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/volume/volume_geometry.h"

namespace octascope::pipeline {

struct Volume;

// log2 of a brick's cells along depth, fast and slow axis. The voxels are three to ten times as
// long along the slow axis as along depth.
inline constexpr int brick_depth_shift = 3;
inline constexpr int brick_a_shift = 2;
inline constexpr int brick_b_shift = 1;

// Bricks along each axis.
struct BrickCounts {
  int depth = 0;
  int a = 0;
  int b = 0;

  std::size_t per_b_scan() const {
    return static_cast<std::size_t>(depth) * static_cast<std::size_t>(a);
  }
  std::size_t all() const { return per_b_scan() * static_cast<std::size_t>(b); }
  bool operator==(const BrickCounts&) const = default;
};

BrickCounts count_bricks(const VolumeGeometry& geometry);

// Threads: update() of different B-scans may run at the same time; highest() and lowest() of a
// B-scan only after its update(). Allocates when it is made, never afterwards.
class Occupancy {
public:
  Occupancy() = default;
  // Depth bins before `first_depth` are ignored: no renderer shows them.
  Occupancy(const VolumeGeometry& geometry, int first_depth);

  // Takes the levels [a][z] of one B-scan. They must be final: averaging with neighbours comes
  // before.
  void update(int b, std::span<const std::uint8_t> levels) noexcept;
  void update(const Volume& volume) noexcept;

  // Takes one B-scan's part of another volume's, of the same geometry and first depth.
  void copy(int b, const Occupancy& from) noexcept;

  // For drawing a copy of the volume whose levels are lower by up to that many counts: all B-scans,
  // or one.
  void widen_below(int counts) noexcept;
  void widen_below(int b, int counts) noexcept;

  bool empty() const { return highest_.empty(); }
  const VolumeGeometry& geometry() const { return geometry_; }
  const BrickCounts& bricks() const { return bricks_; }

  // Of one B-scan, in the order [a brick][depth brick].
  std::span<const std::uint8_t> highest(int b) const { return row(highest_, b); }
  std::span<const std::uint8_t> lowest(int b) const { return row(lowest_, b); }

private:
  std::span<const std::uint8_t> row(const std::vector<std::uint8_t>& of, int b) const {
    return std::span{of}.subspan(bricks_.per_b_scan() * static_cast<std::size_t>(b),
                                 bricks_.per_b_scan());
  }

  std::span<std::uint8_t> row(std::vector<std::uint8_t>& of, int b) {
    return std::span{of}.subspan(bricks_.per_b_scan() * static_cast<std::size_t>(b),
                                 bricks_.per_b_scan());
  }

  VolumeGeometry geometry_;
  BrickCounts bricks_;
  int first_depth_ = 0;
  std::vector<std::uint8_t> highest_;
  std::vector<std::uint8_t> lowest_;
};

} // namespace octascope::pipeline
