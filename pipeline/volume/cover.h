// Tissue that hides other tissue: a layer with a clear gap below it and tissue below that, as the
// cornea over the iris. Drawn weaker, it lets a picture show what lies under it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/volume/occupancy.h"

namespace octascope::pipeline {

// Found in the brightest voxels of an occupancy's bricks. The layers count as a cover only if tissue
// lies under many of them: a thin sheet alone in air stays as it is.
//
// Threads: find() and clear() are bound to one; weaken() may run for several B-scans at once. Allocates,
// copied too, when the geometry changes.
class Cover {
public:
  void find(const Occupancy& occupancy);

  void clear() { share_ = 0; }
  bool empty() const { return share_ <= 0; }

  // Copies the levels [a][z] of one B-scan and lowers those of the cover by that many counts. What
  // is much brighter than the cover stays: instruments, mirror reflections. No level becomes 0.
  void weaken(int b, std::span<const std::uint8_t> levels, float counts,
              std::span<std::uint8_t> to) const noexcept;

  // By which share of the counts, 0 to 1, weaken() lowers what lies there and is not much brighter than
  // the cover. mm from the volume's corner along depth, fast and slow axis.
  float share_at(const std::array<float, 3>& place_mm) const noexcept;

private:
  // Where a layer ends and the gap is half over, as a depth bin; without weight there is none.
  struct Column {
    float end = 0;
    float weight = 0;
  };
  struct Layer {
    int first; // bricks
    int end;
    bool covers; // tissue lies under the gap
  };
  std::optional<Layer> layer_in(std::span<const std::uint8_t> column, std::uint8_t tissue) const;
  Column at(int b, float a) const;
  void bridge();
  void smooth();

  VolumeGeometry geometry_;
  int gap_bricks_ = 0;
  int columns_ = 0;           // per B-scan: a brick's A-scans share one
  std::vector<Column> found_; // [b][column]
  std::vector<Column> smoothed_;
  float share_ = 0; // of the lowering that is done: small where it is doubtful what covers
  int strong_ = 0;  // levels from here on stay
};

} // namespace octascope::pipeline
