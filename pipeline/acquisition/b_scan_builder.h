// A worker's job: turns the frames of a B-scan's sweeps into its levels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "hal/line_camera.h"
#include "pipeline/acquisition/repeat_comparison.h"
#include "pipeline/scan/downsampled_sweep.h"
#include "pipeline/scan/scan_plan.h"
#include "pipeline/scan/sweep_alignment.h"

namespace octascope::pipeline {

// Converts the first ScanPlan::converted_lines() lines of a frame to levels [line][z]; returns the
// number of saturated lines. Called by several workers at once, each with its own index; must not
// throw or allocate.
using ReconstructSweep = std::function<int(std::size_t worker, const hal::LineFrame& frame,
                                           std::span<std::uint8_t> levels)>;

// One worker converts all repeats of a B-scan in turn, so that they are aligned and in its cache
// when their levels are averaged and, on request, their bins compared (repeat_comparison.h).
//
// Levels (decibels) are averaged, as for neighbouring B-scans. Averaging powers would estimate the
// power better, but the mean level of speckle would rise with the number of repeats (by up to
// 2.5 dB), so a display window set for one number would not suit another; and one repeat with a
// flash would outweigh the others.
//
// Immutable except for each worker's own buffers, which are allocated once: build() allocates
// nothing.
class BScanBuilder {
public:
  // `comparison`: of the same plan; empty: nobody asks what flows. Where it is there, it is what
  // converts sweeps, not `reconstruct`.
  BScanBuilder(const ScanPlan& plan, std::size_t workers, ReconstructSweep reconstruct,
               std::optional<RepeatComparison> comparison = std::nullopt);

  // `frames`: one for each repeat, in order; a negative buffer marks a missing one. At least one is
  // present. `sketch` may be null. `levels` [a][z]. Returns the number of saturated lines.
  int build(std::size_t worker, int b_scan, std::span<const hal::LineFrame> frames,
            const SweepAlignment& alignment, DownsampledSweep* sketch,
            std::span<std::uint8_t> levels);

  bool compares() const { return comparison_.has_value(); }
  bool is_whole(std::size_t worker) const { return comparison_->is_whole(worker); }
  // What flows in the B-scan that this worker built last, `flow` in counts, [a][z]. Where it
  // compares.
  FlowState tell_flow(std::size_t worker, std::span<std::uint8_t> flow) noexcept {
    return comparison_->tell(worker, flow);
  }

private:
  struct Buffers {
    std::vector<std::uint8_t> lines;   // bidirectional: a sweep before alignment
    std::vector<std::uint8_t> repeats; // with several repeats: [repeat][a][z]
  };

  int convert(std::size_t worker, int sweep, const hal::LineFrame& frame,
              const SweepAlignment& alignment, DownsampledSweep* sketch,
              std::span<std::uint8_t> levels);

  ScanPlan plan_;
  ReconstructSweep reconstruct_;
  std::optional<RepeatComparison> comparison_;
  std::vector<Buffers> buffers_; // by worker
};

// Rounds to the nearest count. `repeats` holds `count` (1 to ScanPlan::most_repeats) runs of
// average.size() levels, one after another.
void average_repeats(std::span<const std::uint8_t> repeats, int count,
                     std::span<std::uint8_t> average);

} // namespace octascope::pipeline
