// What flows, for the ray caster, and a mark for each cell in which it may be seen.
//
// Little of a volume flows. Rays ask the marks, which take an eighth of the counts' memory (and as much again, by B-scan, to renew
// them from), and fetch few
// counts: these are not interleaved as levels are (cell_volume.h), which would take more time for each
// volume than fewer loads spare.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/volume/volume.h"
#include "ui/ray_caster/large_buffer.h"

namespace octascope::ui {

// Counts as [b][a][z], and below each A-scan's last bin the same once more. A cell
// (pipeline/volume/occupancy.h) is marked when one of its eight corners is first_seen_flow
// (ui/transfer/flow_look.h) or more. Marks are words of 32 cells, 8 along depth in each of 4 along the fast
// axis: [b cell][a cell / 4][z / 8], bit a % 4 · 8 + z % 8.
//
// Threads: update() of different B-scans may run concurrently, and then mark() of different rows. Allocates
// at construction. The volume must fit a CellVolume.
class FlowCells {
public:
  FlowCells() = default;
  explicit FlowCells(const pipeline::VolumeGeometry& geometry);

  // Takes the counts [a][z] of one B-scan.
  void update(int b, std::span<const std::uint8_t> counts) noexcept;
  // Marks the cells between B-scans row − 1 and row, once both are there; 0 to b_scans.
  void mark(int row) noexcept;

  const pipeline::VolumeGeometry& geometry() const { return geometry_; }
  const std::uint8_t* counts() const { return counts_.data(); }
  std::int32_t column_bytes() const { return column_bytes_; }
  std::int32_t slab_bytes() const { return column_bytes_ * geometry_.a_scans; }
  const std::uint32_t* marks() const;
  std::int32_t mark_row() const { return mark_row_; }   // words along the fast axis
  std::int32_t mark_slab() const { return mark_slab_; } // … along the slow axis

private:
  using Word = std::uint32_t;
  const Word* seen(int b) const; // clamped to the volume's

  pipeline::VolumeGeometry geometry_;
  std::int32_t column_bytes_ = 0;
  std::int32_t mark_row_ = 0;
  std::int32_t mark_slab_ = 0;
  LargeBuffer counts_;
  std::vector<Word> seen_; // as the marks, of one B-scan's corners: [b][a cell / 4][z / 8]
  LargeBuffer marks_;
};

} // namespace octascope::ui
