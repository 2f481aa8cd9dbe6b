// The background of a B-scan, interpolated as its lines are: once a B-scan, but in double precision.
#include <cstdint>
#include <cstring>

#include "pipeline/reconstruction/fused/fused_tables.h"
#include "pipeline/threads/cpu_clones.h"

#define OCTASCOPE_INLINE inline __attribute__((always_inline))

namespace octascope::pipeline {

namespace {

using FourDoubles = double __attribute__((vector_size(32)));

// The products of four taps.
OCTASCOPE_INLINE void multiply_four(const float (&values)[4], const std::int16_t* weights,
                                    double offset, FourDoubles& products) {
  std::int32_t __attribute__((vector_size(16))) taps;
  float __attribute__((vector_size(16))) four;
  for (int i = 0; i < 4; ++i)
    taps[i] = weights[i];
  std::memcpy(&four, &values, sizeof four);
  products = (__builtin_convertvector(four, FourDoubles) - offset) *
             __builtin_convertvector(taps, FourDoubles);
}

OCTASCOPE_INLINE void multiply_four(const float* values, const std::int16_t* weights, double offset,
                                    FourDoubles& products) {
  float four[4];
  std::memcpy(four, values, sizeof four);
  multiply_four(four, weights, offset, products);
}

// Four neighbouring results, from tap_starts `first` on.
template <int Width>
OCTASCOPE_INLINE void resample_four(const float* background, const std::int32_t* first,
                                    const std::int16_t* weights, double offset, FourDoubles& sums) {
  if constexpr (Width == 2) {
    FourDoubles p[2];
    for (int i = 0; i < 2; ++i) {
      const float* one = background + first[2 * i];
      const float* other = background + first[2 * i + 1];
      multiply_four({one[0], one[1], other[0], other[1]}, weights + 4 * i, offset, p[i]);
    }
    sums = __builtin_shufflevector(p[0], p[1], 0, 2, 4, 6) +
           __builtin_shufflevector(p[0], p[1], 1, 3, 5, 7);
    return;
  }
  FourDoubles p[4];
  for (int i = 0; i < 4; ++i) {
    multiply_four(background + first[i], weights + i * Width, offset, p[i]);
    if constexpr (Width == 8) {
      FourDoubles further;
      multiply_four(background + first[i] + 4, weights + i * Width + 4, offset, further);
      p[i] += further;
    }
  }
  const FourDoubles a = __builtin_shufflevector(p[0], p[1], 0, 4, 2, 6) + // p0 p1 p0 p1, halves
                        __builtin_shufflevector(p[0], p[1], 1, 5, 3, 7);
  const FourDoubles b = __builtin_shufflevector(p[2], p[3], 0, 4, 2, 6) +
                        __builtin_shufflevector(p[2], p[3], 1, 5, 3, 7);
  sums = __builtin_shufflevector(a, b, 0, 1, 4, 5) + __builtin_shufflevector(a, b, 2, 3, 6, 7);
}

template <int Width>
OCTASCOPE_INLINE void resample(const FusedTables& tables, const float* background, double offset,
                               std::int32_t* resampled) {
  for (std::size_t m = 0; m < tables.tap_starts.size(); m += 4) { // four share a block
    FourDoubles sums;
    resample_four<Width>(background, tables.tap_starts.data() + m,
                         tables.tap_weights.data() + m * std::size_t{Width}, offset, sums);
    // 1.5·2^52 puts the nearest integer into the low bits, as lrint() rounds.
    sums += 6755399441055744.0;
    std::int64_t nearest[4];
    std::memcpy(nearest, &sums, sizeof nearest);
    for (int i = 0; i < 4; ++i)
      resampled[tables.block_of[m] + i] = static_cast<std::int32_t>(nearest[i]);
  }
}

#define OCTASCOPE_RESAMPLE(name, width)                                                            \
  OCTASCOPE_CPU_CLONES void name(const FusedTables& tables, const float* background,               \
                                 double offset, std::int32_t* resampled) {                         \
    resample<width>(tables, background, offset, resampled);                                        \
  }

OCTASCOPE_RESAMPLE(resample_2, 2)
OCTASCOPE_RESAMPLE(resample_4, 4)
OCTASCOPE_RESAMPLE(resample_8, 8)

} // namespace

void FusedTables::resample_background(const float* background, int offset,
                                      std::int32_t* resampled) const {
  const auto resample = tap_pairs == 1 ? &resample_2 : tap_pairs == 2 ? &resample_4 : &resample_8;
  resample(*this, background, offset, resampled);
}

} // namespace octascope::pipeline
