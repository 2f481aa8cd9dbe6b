// Everything that the fused reconstruction looks up instead of computing: taps, factors, twiddles,
// laid out in the order in which one set of kernels consumes them.
//
// N = L·J samples, L lanes a register, in J blocks of L consecutive samples: sample n = L·j + l.
// Bin k = k1 + J·k2, where k1 comes out of transforms of J points over the blocks, lane by lane,
// and k2 out of transforms of L points over the lanes.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <new>
#include <optional>
#include <span>
#include <vector>

#include "pipeline/calibration/calibration.h"

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
inline constexpr int first_radix = 8;
inline constexpr int fewest_blocks = 32; // J: radices 8 and 4

struct FusedTables {
  int samples = 0;
  int lanes = 0;
  int blocks = 0; // J
  int right_shift = 0;
  int tap_pairs = 0;       // 1, 2 or 4
  bool one_window = true;  // holds all taps of its outputs, for each block
  bool real_input = false; // no dispersion phase

  // Blocks in the order in which the first pass uses them: j0, j0 + J/8, … j0 + 7·J/8 for each j0.
  // Per block: window starts, permutation (the same for all pairs: the window moves on by two
  // samples a pair), and for each pair the weights of both taps of each lane.
  AlignedVector<std::int32_t> window_starts;
  AlignedVector<std::uint8_t> permutations;
  AlignedVector<std::int16_t> weights;
  // Per block: L real and, unless the input is real, L imaginary parts of w[m]·exp(iθ[m])/(N·2^14).
  AlignedVector<float> factors;

  // The J-point transform: radices, the first being first_radix, and for each pass but the last
  // exp(−2πi·j·q/S), q = 1 … R−1, for a pass over groups of S blocks.
  std::array<int, 4> radices{};
  int passes = 0;
  std::array<AlignedVector<float>, 3> pass_twiddles;
  // Per result k1 of the last pass, in its order: L real and L imaginary parts of
  // exp(−2πi·l·k1/N).
  AlignedVector<float> last_twiddles;
  // exp(−2πi·i·v/L) for v = 1 … L/4−1, where i is the lane within four; per v L real, L imaginary.
  AlignedVector<float> lane_twiddles;

  // The last pass leaves rows of L·R/2 levels; row q holds bins q + offset, the same offsets for
  // all rows.
  std::vector<std::int32_t> last_rows; // by group of the last pass
  std::vector<std::int32_t> offsets_u8;
  std::vector<std::int32_t> offsets_db;

  // Fixed-point taps in the order of the samples, for the background: x[m] = Σ_t w[m·T+t]·s[f[m]+t]
  std::vector<std::int32_t> tap_starts;
  std::vector<std::int16_t> tap_weights;
  std::vector<std::int32_t> block_of; // where sample m lies among the blocks: block·L + lane

  int last_radix() const { return radices[static_cast<std::size_t>(passes - 1)]; }

  // Interpolates a background (counts) less `offset` into `resampled`, in 2^−14 counts, in block
  // order. Allocates nothing.
  void resample_background(const float* background, int offset, std::int32_t* resampled) const;
};

// Nothing where the fused path does not apply: N not a power of two from 256 to 8192 or with fewer
// blocks than fewest_blocks, or positions too steep for the windows.
std::optional<FusedTables> make_fused_tables(const Calibration& calibration, int right_shift,
                                             const WindowShape& shape);

} // namespace octascope::pipeline
