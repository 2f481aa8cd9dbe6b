// The sweeps of a volume at low depth resolution, for estimating how they are displaced.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/scan/scan_plan.h"

namespace octascope::pipeline {

// Levels of all converted lines of each sweep, in time order, averaged over bands of neighbouring
// depths: [sweep][line][band]. Workers write it (each its own sweeps); one thread reads it when all
// are done. The caller must synchronise the hand-over.
class DownsampledSweep {
public:
  static constexpr int bands = 32;

  // Allocates all memory.
  explicit DownsampledSweep(const ScanPlan& plan);

  // Marks all sweeps as not received.
  void clear();
  // `levels` [line][z] of a sweep. Allocates nothing.
  void draw(int sweep, std::span<const std::uint8_t> levels) noexcept;

  int sweeps() const { return static_cast<int>(came_.size()); }
  int lines() const { return lines_; }
  bool came(int sweep) const { return came_[static_cast<std::size_t>(sweep)] != 0; }
  // `bands` values; with fewer depths than bands, the remainder are 0.
  std::span<const std::uint8_t> line(int sweep, int line) const {
    return std::span{strokes_}.subspan(
        static_cast<std::size_t>(sweep * lines_ + line) * static_cast<std::size_t>(bands), bands);
  }

private:
  int lines_;
  std::size_t depths_;
  std::vector<std::uint8_t> strokes_;
  std::vector<std::uint8_t> came_; // by sweep; not bool: workers write neighbours
};

} // namespace octascope::pipeline
