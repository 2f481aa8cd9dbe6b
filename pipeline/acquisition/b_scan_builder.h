// A worker's job: from the frames of a B-scan's sweeps to its levels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "hal/line_camera.h"
#include "pipeline/scan/downsampled_sweep.h"
#include "pipeline/scan/scan_plan.h"
#include "pipeline/scan/sweep_alignment.h"

namespace octascope::pipeline {

// Converts the first ScanPlan::converted_lines() lines of a frame to levels [line][z]; returns the
// number of saturated lines. Called by several workers at once, each with its own number; must not
// throw or allocate.
using ReconstructSweep = std::function<int(std::size_t worker, const hal::LineFrame& frame,
                                           std::span<std::uint8_t> levels)>;

// All repeats of a B-scan are converted one behind the other by one worker, so that they are in its
// cache side by side, aligned, when their levels are averaged: whatever else compares repeats has
// its place there.
//
// Levels (decibels) are averaged, as those of neighbours are. An average of powers would be the
// better estimate of a power, but the mean level of speckle then rises with the number of repeats
// (by up to 2.5 dB), and a display window set with one number would not fit another; and a repeat
// in which something flashed by outweighs the others.
//
// Immutable but for each worker's own buffers, which are made once: build() allocates nothing.
class BScanBuilder {
public:
  BScanBuilder(const ScanPlan& plan, std::size_t workers, ReconstructSweep reconstruct);

  // `frames`: one for each repeat, in order; those with a negative buffer did not come, one at
  // least did. `sketch` may be null. `levels` [a][z]. Returns the number of saturated lines.
  int build(std::size_t worker, int b_scan, std::span<const hal::LineFrame> frames,
            const SweepAlignment& alignment, DownsampledSweep* sketch,
            std::span<std::uint8_t> levels);

private:
  struct Buffers {
    std::vector<std::uint8_t> lines;   // bidirectional: a sweep as it came
    std::vector<std::uint8_t> repeats; // several: [repeat][a][z]
  };

  int convert(std::size_t worker, int sweep, const hal::LineFrame& frame,
              const SweepAlignment& alignment, DownsampledSweep* sketch,
              std::span<std::uint8_t> levels);

  ScanPlan plan_;
  ReconstructSweep reconstruct_;
  std::vector<Buffers> buffers_; // by worker
};

// Rounds to the nearest count. `repeats` holds `count` (1 to ScanPlan::most_repeats) runs of
// average.size() levels, one behind the other.
void average_repeats(std::span<const std::uint8_t> repeats, int count,
                     std::span<std::uint8_t> average);

} // namespace octascope::pipeline
