// A worker's second job, where it is asked for: compares the repeats of a B-scan and says what flows
// in it (docs/ANGIOGRAPHY.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "hal/line_camera.h"
#include "hal/result.h"
#include "pipeline/angiography/b_scan_flow.h"
#include "pipeline/scan/scan_plan.h"
#include "pipeline/volume/volume.h"

namespace octascope::pipeline {

// What becomes of a sweep. All [line][z] but the last.
struct SweepBins {
  std::span<PackedBin> bins;
  std::span<std::uint8_t> levels;    // of those bins, as ReconstructSweep gives them
  std::span<std::uint8_t> saturated; // by line: set to 1 where it is saturated, else left alone
};

// Otherwise as ReconstructSweep: one transform for both.
using ReconstructBins =
    std::function<int(std::size_t worker, const hal::LineFrame& frame, const SweepBins& out)>;

// Threads: each worker with its own index. Allocates when it is made, 8 bytes a voxel of each repeat
// and some 20 a voxel for each worker, and never afterwards.
class RepeatComparison {
public:
  // ErrorCode::invalid_argument: the plan has no repeats, or is bidirectional, so that successive
  // sweeps of a B-scan run in opposite directions, and the mirror's lag lies between them.
  static hal::Result<> check(const ScanPlan& plan);

  // As check().
  static hal::Result<RepeatComparison> create(const ScanPlan& plan, std::size_t workers,
                                              ReconstructBins reconstruct);

  // Before the first sweep of a B-scan.
  void begin(std::size_t worker) noexcept;
  // Converts a sweep to `levels` and keeps its bins. Returns the number of saturated lines.
  int convert(std::size_t worker, int repeat, const hal::LineFrame& frame,
              std::span<std::uint8_t> levels);
  // All sweeps of the B-scan came.
  bool is_whole(std::size_t worker) const { return buffers_[worker].came == plan_.repeats; }
  // What flows in the B-scan of which these sweeps came, as counts (flow_scale.h), [a][z]. Where one
  // is missing nothing is told; nor is it in and beside a saturated line, whose change is the
  // clipping's.
  FlowState tell(std::size_t worker, std::span<std::uint8_t> flow) noexcept;

private:
  struct Buffers {
    BScanFlow flow;
    std::vector<PackedBin> bins; // [repeat][a][z]
    std::vector<float> told, decorrelation;
    std::vector<std::uint8_t> saturated; // by A-scan, in any of the repeats
    int came = 0;
  };

  RepeatComparison(const ScanPlan& plan, ReconstructBins reconstruct)
      : plan_(plan), reconstruct_(std::move(reconstruct)) {}
  void darken_saturated(Buffers& buffers) const noexcept;
  void leave_saturated_untold(const Buffers& buffers, std::span<std::uint8_t> flow) const noexcept;

  ScanPlan plan_;
  ReconstructBins reconstruct_;
  std::vector<Buffers> buffers_; // by worker
};

} // namespace octascope::pipeline
