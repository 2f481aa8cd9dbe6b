// Where something is seen to flow, a bit for each cell of a volume, built as B-scans arrive.
//
// Little of a volume flows. Who draws it looks at these, an eighth of the counts' memory, and reads the
// counts only where they say so.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/volume/volume_geometry.h"

namespace octascope::pipeline {

// Fewer counts (flow_scale.h) are seen nowhere: below half of what flows for certain.
inline constexpr std::uint8_t first_marked_flow = 0x80;

// Cells and bricks are those of occupancy.h; a word has the cells of a brick in one row along the slow
// axis: 8 along depth in each of 4 along the fast axis. Of each B-scan alone: [a cell / 4][z / 8], bit
// a % 4 · 8 + z % 8, set when one of the cell's corners in the B-scan is marked.
//
// Threads: update(), clear() and copy() of different B-scans may run at the same time. Allocates when it is
// made, never afterwards.
class FlowMarks {
public:
  FlowMarks() = default;
  // Depth bins before `first_depth`, 0 to 8, are ignored: no renderer shows them.
  FlowMarks(const VolumeGeometry& geometry, int first_depth);

  // Takes the counts [a][z] of one B-scan.
  void update(int b, std::span<const std::uint8_t> counts) noexcept;
  // Nothing flows in it.
  void clear(int b) noexcept;
  // Takes one B-scan's part of another volume's, of the same geometry and first depth.
  void copy(int b, const FlowMarks& from) noexcept;

  bool empty() const { return words_.empty(); }
  const VolumeGeometry& geometry() const { return geometry_; }
  std::int32_t row() const { return row_; }   // words along depth
  std::int32_t slab() const { return slab_; } // … of a B-scan
  std::span<const std::uint32_t> of(int b) const {
    return std::span{words_}.subspan(static_cast<std::size_t>(b) * static_cast<std::size_t>(slab_),
                                     static_cast<std::size_t>(slab_));
  }

private:
  std::span<std::uint32_t> own(int b) {
    return std::span{words_}.subspan(static_cast<std::size_t>(b) * static_cast<std::size_t>(slab_),
                                     static_cast<std::size_t>(slab_));
  }
  void mark_sides(std::span<std::uint32_t> words, int a,
                  std::span<const std::uint8_t> counts) const noexcept;

  VolumeGeometry geometry_;
  std::int32_t row_ = 0;
  std::int32_t slab_ = 0;
  std::uint8_t ignored_ = 0; // bits of the first eight bins
  std::vector<std::uint32_t> words_;
};

} // namespace octascope::pipeline
