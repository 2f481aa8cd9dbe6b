// The volume in the ray caster's layout: one 4-byte load fetches a cell's corners in one B-scan.
#pragma once

#include <cstdint>
#include <span>

#include "pipeline/volume/volume.h"
#include "ui/ray_caster/large_buffer.h"

namespace octascope::ui {

// Levels of two neighbouring A-scans interleaved, depth fastest: [b cell row][a cell][z][2]. Row r
// holds B-scan r−1, the first and last are repeated; cells as pipeline/volume/occupancy.h numbers
// them. Costs twice the volume's memory and a copy, and halves the loads of every sample.
//
// Threads: update() of different B-scans may run at the same time. Allocates when it is made.
class CellVolume {
public:
  CellVolume() = default;
  explicit CellVolume(const pipeline::VolumeGeometry& geometry);

  // Whether the kernels' 32-bit offsets suffice.
  static bool fits(const pipeline::VolumeGeometry& geometry);

  // Copies the levels [a][z] of one B-scan.
  void update(int b, std::span<const std::uint8_t> levels) noexcept;

  const pipeline::VolumeGeometry& geometry() const { return geometry_; }
  const std::uint8_t* data() const { return cells_.data(); }
  std::int32_t column_bytes() const { return column_bytes_; }
  std::int32_t row_bytes() const { return row_bytes_; }

private:
  void fill_row(int row, std::span<const std::uint8_t> levels) noexcept;

  pipeline::VolumeGeometry geometry_;
  std::int32_t column_bytes_ = 0;
  std::int32_t row_bytes_ = 0;
  LargeBuffer cells_;
};

} // namespace octascope::ui
