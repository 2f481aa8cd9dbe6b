// The volume in the ray caster's memory layout: one 4-byte load fetches the four corners of a cell
// in one B-scan.
#pragma once

#include <cstdint>
#include <span>

#include "pipeline/volume/volume.h"
#include "ui/ray_caster/large_buffer.h"

namespace octascope::ui {

// Levels of two neighbouring A-scans interleaved, depth fastest: [b cell row][a cell][z][2]. Row r
// holds B-scan r−1; the first and last are repeated; for cells see pipeline/volume/occupancy.h.
// Takes twice the volume's memory and one copying pass, and halves the loads of every sample.
//
// Threads: update() of different B-scans may run concurrently. Allocates at construction.
class CellVolume {
public:
  CellVolume() = default;
  explicit CellVolume(const pipeline::VolumeGeometry& geometry);

  // Along any axis: positions have 16 bits for the fraction, one for the sign.
  static constexpr int longest = 32000;

  // Whether the offsets fit in 32 bits, as the kernels require.
  static bool fits(const pipeline::VolumeGeometry& geometry);

  // Takes the levels [a][z] of one B-scan.
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
