// A volume's sweeps in coarse strokes: enough to see how they lie to each other, small enough to
// keep beside the volume.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "pipeline/scan/scan_plan.h"

namespace octascope::pipeline {

// Of each sweep the levels of all its converted lines, in the order of time, averaged over bands of
// neighbouring depths: [sweep][line][band]. Made by the workers (each its own sweeps), read by one
// thread when all are done; whoever hands it over orders the two.
class DownsampledSweep {
public:
  static constexpr int bands = 32;

  // Allocates all that it will need.
  explicit DownsampledSweep(const ScanPlan& plan);

  // No sweep has come.
  void clear();
  // `levels` [line][z] of a sweep. Allocates nothing.
  void draw(int sweep, std::span<const std::uint8_t> levels) noexcept;

  int sweeps() const { return static_cast<int>(came_.size()); }
  int lines() const { return lines_; }
  bool came(int sweep) const { return came_[static_cast<std::size_t>(sweep)] != 0; }
  // bands values each; where there are fewer depths than bands the rest are 0.
  std::span<const std::uint8_t> line(int sweep, int line) const {
    return std::span{strokes_}.subspan(
        static_cast<std::size_t>(sweep * lines_ + line) * static_cast<std::size_t>(bands), bands);
  }

private:
  int lines_;
  std::size_t depths_;
  std::vector<std::uint8_t> strokes_;
  std::vector<std::uint8_t> came_; // by sweep; bytes, as workers write neighbours
};

} // namespace octascope::pipeline
