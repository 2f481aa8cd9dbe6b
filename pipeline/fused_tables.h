// Everything that the fused reconstruction looks up instead of computing: taps, factors, twiddles,
// laid out in the order in which one set of kernels consumes them.
//
// N = L·M samples, L lanes a register. Sample n = M·a + b; bin k = k2 + L·k1. A block is one
// register of L consecutive samples; blocks are numbered in the order of use, c = (b/L)·L + a.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <new>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/calibration.h"

namespace octascope::pipeline {

// Memory that starts on a cache line, as whole registers are loaded from it.
template <class T> struct CacheLineAllocator {
  using value_type = T;
  static constexpr std::align_val_t alignment{64};
  CacheLineAllocator() = default;
  template <class Other> explicit CacheLineAllocator(const CacheLineAllocator<Other>&) {}
  T* allocate(std::size_t count) {
    return static_cast<T*>(::operator new(count * sizeof(T), alignment));
  }
  void deallocate(T* memory, std::size_t) { ::operator delete(memory, alignment); }
  bool operator==(const CacheLineAllocator&) const { return true; }
};
template <class T> using AlignedVector = std::vector<T, CacheLineAllocator<T>>;

// How one set of kernels reads raw samples: `outputs` neighbouring results come out of one window
// of `samples` raw ones by a permutation.
struct WindowShape {
  int lanes;
  int outputs;
  int samples;
  bool byte_indices; // of the permutation; 16-bit indices otherwise
};

inline constexpr int weight_bits = 14; // weights are fixed-point numbers, Q14

struct FusedTables {
  int samples = 0;
  int lanes = 0;
  int right_shift = 0;
  int tap_pairs = 0; // 1, 2 or 4

  // Per block: window starts, permutation (the same for all pairs: the window moves on by two
  // samples a pair), and for each pair the weights of both taps of each lane.
  AlignedVector<std::int32_t> window_starts;
  AlignedVector<std::uint8_t> permutations;
  AlignedVector<std::int16_t> weights;
  // Per block: L real and L imaginary parts of w[m]·exp(iθ[m])/(N·2^14).
  AlignedVector<float> factors;

  // Per block of the first radix' results (k2 = 0 … L−1 for each b/L): exp(−2πi·b·k2/N).
  AlignedVector<float> first_twiddles;
  // The M-point transform: radices, and for each pass but the last exp(−2πi·j·q/S), q = 1 … R−1.
  std::array<int, 4> radices{};
  int passes = 0;
  std::array<AlignedVector<float>, 3> pass_twiddles;
  AlignedVector<std::int32_t> last_offsets; // first output register of each group of the last pass

  // Fixed-point taps in the order of the samples, for the background: x[m] = Σ_t w[m·T+t]·s[f[m]+t]
  std::vector<std::int32_t> tap_starts;
  std::vector<std::int16_t> tap_weights;
  std::vector<std::int32_t> block_of; // where sample m lies among the blocks: block·L + lane

  // Interpolates a background (counts) less `offset` into `resampled`, in 2^−14 counts, in block
  // order. Allocates nothing.
  void resample_background(const float* background, int offset, std::int32_t* resampled) const;
};

// Nothing where the fused path does not apply: N not a power of two from 256 to 8192, or positions
// too steep for the windows.
std::optional<FusedTables> make_fused_tables(const Calibration& calibration, int right_shift,
                                             const WindowShape& shape);

} // namespace octascope::pipeline
