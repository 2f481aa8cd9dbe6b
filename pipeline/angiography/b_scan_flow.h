// What flows in one B-scan, from the complex bins of its repeated sweeps (docs/ANGIOGRAPHY.md).
//
// Each repeat is brought back to where the first one was (bulk_motion.h); successive repeats are
// compared over a small kernel, the phase that each A-scan turned by as a whole taken off; and what
// decorrelates more than noise explains is flow (static_tissue.h). With repeats Y_1 … Y_M and Σ over
// the M − 1 pairs and the kernel of 3 A-scans by 5 depths around a voxel:
//   complex bins: D = 1 − |Σ Y_m·conj(Y_m+1)·exp(−iφ)| / ½Σ(|Y_m|² + |Y_m+1|²),
//                 φ = arg Σ over all depths of the A-scan's Y_m·conj(Y_m+1);
//   intensities:  D = 1 − 2Σ I_m·I_m+1 / Σ(I_m² + I_m+1²), I = |Y|².
// The first is after the complex differential variance of A. S. Nam, I. Chico-Calero and B. J. Vakoc,
// Biomed. Opt. Express 5, 3822 (2014); they take the modulus pair by pair.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "hal/result.h"
#include "pipeline/angiography/bulk_motion.h"
#include "pipeline/angiography/kernel_sums.h"
#include "pipeline/angiography/static_tissue.h"
#include "pipeline/volume/packed_bin.h"

namespace octascope::pipeline {

struct FlowSetup {
  int repeats = 2; // sweeps of each B-scan, 2 to 4
  int a_scans = 0;
  int depths = 0;
  FlowMethod method = FlowMethod::complex_bins;
};

struct FlowOutcome {
  // Repeats, be it one of several, that have nothing in common, or moved too far: the flow of this
  // B-scan is NaN.
  bool left_out = false;
  BulkMotion largest_motion;      // of a repeat against the one before
  float static_decorrelation = 0; // of tissue that does not flow, noise taken off
};

// Buffers are allocated once; one object a thread. The result of a B-scan depends on its bins alone.
class BScanFlow {
public:
  static constexpr int fewest_repeats = 2;
  static constexpr int most_repeats = 4;

  // ErrorCode::invalid_argument: repeats out of range, or no A-scans or depths.
  static hal::Result<BScanFlow> create(const FlowSetup& setup);

  std::size_t voxels() const { return voxels_; }

  // `bins`: repeats × voxels() of them, [repeat][a][z]. `flow`, [a][z]: 0 static … 1 flowing, NaN
  // where it cannot be told. `decorrelation`: D above, likewise, before anything is decided, of
  // B-scans that are left out as well; 1 where repeats have no power or do not overlap. Allocates
  // nothing, locks nothing, logs nothing.
  FlowOutcome compute(std::span<const PackedBin> bins, std::span<float> flow,
                      std::span<float> decorrelation) noexcept;

private:
  explicit BScanFlow(const FlowSetup& setup);

  // One A-scan's sums over all pairs of repeats, in a ring of as many as the kernel has.
  struct LineSums {
    std::vector<float> like, other, power;
    float pairs = 0;
  };
  struct Repeat {
    FractionalShift shift;
    int lateral = 0;
    std::vector<float> real, imaginary; // of the A-scan at hand, brought back
  };

  void find_motion(std::span<const PackedBin> bins, FlowOutcome& outcome) noexcept;
  void sum_line(std::span<const PackedBin> bins, int a, LineSums& sums) noexcept;
  void finish_line(int a, std::span<float> decorrelation) noexcept;
  void decorrelate(std::span<const PackedBin> bins, std::span<float> decorrelation) noexcept;

  FlowSetup setup_;
  std::size_t voxels_;
  BulkMotionEstimator motion_;
  AxialCoherence coherence_;
  StaticTissue tissue_;
  std::array<Repeat, most_repeats> repeats_;
  std::array<LineSums, kernel_a_scans> ring_;
  std::vector<float> scratch_;
  std::array<std::vector<float>, 3> columns_; // sums over A-scans, with a margin at either end
  std::vector<float> scale_;
  std::vector<float> depth_weights_; // 1 / depths of the kernel that lie within the B-scan
  std::vector<float> level_;
  std::vector<float> second_moment_;
};

} // namespace octascope::pipeline
