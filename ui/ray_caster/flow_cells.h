// What flows, for the ray caster, and a mark for each cell in which it may be seen.
//
// Little of a volume flows. Rays ask the marks and fetch few counts; only what they may fetch is copied, and
// not interleaved as levels are (cell_volume.h).
#pragma once

#include <cstdint>
#include <span>

#include "pipeline/volume/flow_marks.h"
#include "ui/ray_caster/large_buffer.h"

namespace octascope::ui {

// Counts as [b][a][z], and below each A-scan's last bin the same once more: those at the corners of marked
// cells; the others are of no volume. A cell is marked when one of its eight corners is first_seen_flow
// (ui/transfer/flow_look.h) or more. Marks are words as FlowMarks has them, of cells between two B-scans:
// [b cell][a cell / 4][z / 8].
//
// Threads: take() of different B-scans may run concurrently. Allocates at construction. The volume must
// fit a CellVolume.
class FlowCells {
public:
  FlowCells() = default;
  explicit FlowCells(const pipeline::VolumeGeometry& geometry);

  // Takes of one B-scan the counts [a][z] that may be fetched, and the marks of the cells between it and
  // the one before it; with the last one those behind it, too. `marks`: of this one and of those beside it.
  void take(int b, std::span<const std::uint8_t> counts, const pipeline::FlowMarks& marks) noexcept;

  const pipeline::VolumeGeometry& geometry() const { return geometry_; }
  const std::uint8_t* counts() const { return counts_.data(); }
  std::int32_t column_bytes() const { return column_bytes_; }
  std::int32_t slab_bytes() const { return column_bytes_ * geometry_.a_scans; }
  const std::uint32_t* marks() const;
  std::int32_t mark_row() const { return mark_row_; }   // words along the fast axis
  std::int32_t mark_slab() const { return mark_slab_; } // … along the slow axis

private:
  void copy(int b, int word_row, int from, int to, std::span<const std::uint8_t> counts) noexcept;
  std::uint32_t* marks_of(int row);

  pipeline::VolumeGeometry geometry_;
  std::int32_t column_bytes_ = 0;
  std::int32_t mark_row_ = 0;
  std::int32_t mark_slab_ = 0;
  LargeBuffer counts_;
  LargeBuffer marks_;
};

} // namespace octascope::ui
