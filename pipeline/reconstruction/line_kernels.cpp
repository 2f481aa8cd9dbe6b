#include "pipeline/reconstruction/line_kernels.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include "pipeline/reconstruction/fused/fast_level.h"
#include "pipeline/threads/cpu_clones.h"

#define OCTASCOPE_INLINE inline __attribute__((always_inline))

namespace octascope::pipeline {

namespace {

template <class Count>
OCTASCOPE_INLINE std::uint32_t load_counts(const Count* counts, const float* background,
                                           int right_shift, int samples, float* line) {
  Count highest = 0;
  for (int p = 0; p < samples; ++p) {
    const auto count = static_cast<Count>(counts[p] >> right_shift);
    highest = count > highest ? count : highest;
    line[p] = static_cast<float>(count) - background[p];
  }
  return highest;
}

template <class Sum, class Count> OCTASCOPE_INLINE Sum shifted(Count count, int right_shift) {
  if constexpr (std::is_integral_v<Count>)
    return static_cast<Sum>(count >> right_shift);
  else
    return static_cast<Sum>(count);
}

// Lines are summed several at a time, `block_bytes` of each: the sums are loaded and stored less
// often.
constexpr std::size_t lines_at_once = 8;
constexpr std::size_t block_bytes = 128;

// One block of each line, `stride` counts apart.
template <class Count, class Sum>
OCTASCOPE_INLINE void sum_block(const Count* counts, std::size_t stride, int right_shift,
                                Sum* sum) {
  for (std::size_t p = 0; p < block_bytes / sizeof(Count); ++p) {
    Sum of_lines{};
    for (std::size_t i = 0; i < lines_at_once; ++i)
      of_lines += shifted<Sum>(counts[i * stride + p], right_shift);
    sum[p] += of_lines;
  }
}

// Without widening each count: their sum modulo 2^16 and the sum of their upper bytes, which fits,
// tell the sum of the lower bytes, which fits as well.
OCTASCOPE_INLINE void sum_block(const std::uint16_t* counts, std::size_t stride, int right_shift,
                                std::uint32_t* sum) {
  using Words = std::uint16_t __attribute__((vector_size(block_bytes)));
  Words all{};
  Words upper{};
  for (std::size_t i = 0; i < lines_at_once; ++i) {
    Words words;
    std::memcpy(&words, counts + i * stride, sizeof words);
    words >>= static_cast<std::uint16_t>(right_shift);
    all += words;
    upper += words >> 8;
  }
  std::uint16_t high[sizeof all / 2];
  std::uint16_t low[sizeof all / 2];
  all -= upper << 8;
  std::memcpy(high, &upper, sizeof high);
  std::memcpy(low, &all, sizeof low);
  for (std::size_t p = 0; p < sizeof all / 2; ++p)
    sum[p] += (static_cast<std::uint32_t>(high[p]) << 8) + low[p];
}

// The counts come from memory, and this is the first to read them. Processors fetch ahead what is
// read in sequence, but no further than the page and not fast enough for one sequence: so the lines
// at a time are far apart, each the next one of its part of the B-scan.
template <class Count, class Sum>
OCTASCOPE_INLINE void sum_counts(const Count* counts, int lines, int right_shift, int samples,
                                 Sum* sum) {
  const auto stride = static_cast<std::size_t>(samples);
  const std::size_t part = static_cast<std::size_t>(lines) / lines_at_once * stride;
  const std::size_t all = static_cast<std::size_t>(lines) * stride;
  constexpr std::size_t block = block_bytes / sizeof(Count);
  const std::size_t blocks_end = stride / block * block;
  std::fill_n(sum, stride, Sum{});
  for (std::size_t line = 0; line < part; line += stride) {
    for (std::size_t p = 0; p < blocks_end; p += block)
      sum_block(counts + line + p, part, right_shift, sum + p);
    for (std::size_t i = 0; i < lines_at_once; ++i)
      for (std::size_t p = blocks_end; p < stride; ++p)
        sum[p] += shifted<Sum>(counts[i * part + line + p], right_shift);
  }
  for (std::size_t line = lines_at_once * part; line < all; line += stride)
    for (std::size_t p = 0; p < stride; ++p)
      sum[p] += shifted<Sum>(counts[line + p], right_shift);
}

template <class Count>
OCTASCOPE_INLINE bool add_counts_below(const Count* counts, std::uint32_t limit, int right_shift,
                                       int samples, float* sum) {
  Count highest = 0;
  for (int p = 0; p < samples; ++p)
    highest = counts[p] > highest ? counts[p] : highest;
  if (static_cast<std::uint32_t>(highest >> right_shift) >= limit)
    return false;
  for (int p = 0; p < samples; ++p)
    sum[p] += static_cast<float>(counts[p] >> right_shift);
  return true;
}

// Four lanes everywhere: a tap window of 8 is two of them, and adding up the lanes of four windows
// at once takes three shuffled additions, fewer than with wider registers.
using Lanes = float __attribute__((vector_size(16)));

OCTASCOPE_INLINE void load(Lanes& lanes, const float* from) {
  std::memcpy(&lanes, from, sizeof lanes);
}

// result[i] = the sum of the lanes of sums[i].
OCTASCOPE_INLINE void add_lanes(const Lanes (&sums)[4], Lanes& result) {
  const Lanes a = __builtin_shufflevector(sums[0], sums[1], 0, 4, 1, 5) +
                  __builtin_shufflevector(sums[0], sums[1], 2, 6, 3, 7); // s0 s1 s0 s1, half sums
  const Lanes b = __builtin_shufflevector(sums[2], sums[3], 0, 4, 1, 5) +
                  __builtin_shufflevector(sums[2], sums[3], 2, 6, 3, 7);
  result = __builtin_shufflevector(a, b, 0, 1, 4, 5) + __builtin_shufflevector(a, b, 2, 3, 6, 7);
}

template <int Width>
OCTASCOPE_INLINE void interpolate(const float* line, const std::int32_t* first,
                                  const float* weights, Lanes& counts) {
  if constexpr (Width == 0) {
    load(counts, line);
  } else {
    Lanes sums[4];
    for (int i = 0; i < 4; ++i) {
      const float* window = line + first[i];
      Lanes pixels;
      Lanes taps;
      load(pixels, window);
      load(taps, weights + i * Width);
      sums[i] = pixels * taps;
      if constexpr (Width == 8) {
        load(pixels, window + 4);
        load(taps, weights + i * Width + 4);
        sums[i] += pixels * taps;
      }
    }
    add_lanes(sums, counts);
  }
}

template <int Width, bool Complex>
OCTASCOPE_INLINE void shape(const float* line, const std::int32_t* first, const float* weights,
                            const float* factors, int samples, float* shaped) {
  for (int m = 0; m < samples; m += 4) {
    Lanes counts;
    if constexpr (Width == 0)
      interpolate<Width>(line + m, nullptr, nullptr, counts);
    else
      interpolate<Width>(line, first + m, weights + static_cast<std::ptrdiff_t>(m) * Width, counts);
    Lanes factor;
    if constexpr (Complex) {
      load(factor, factors + 2 * m);
      const Lanes left = __builtin_shufflevector(counts, counts, 0, 0, 1, 1) * factor;
      load(factor, factors + 2 * m + 4);
      const Lanes right = __builtin_shufflevector(counts, counts, 2, 2, 3, 3) * factor;
      std::memcpy(shaped + 2 * m, &left, sizeof left);
      std::memcpy(shaped + 2 * m + 4, &right, sizeof right);
    } else {
      load(factor, factors + m);
      const Lanes product = counts * factor;
      std::memcpy(shaped + m, &product, sizeof product);
    }
  }
}

#define OCTASCOPE_SHAPE_LINE(name, width, complex_factors)                                         \
  OCTASCOPE_CPU_CLONES void name(const float* line, const std::int32_t* first,                     \
                                 const float* weights, const float* factors, int samples,          \
                                 float* shaped) {                                                  \
    shape<width, complex_factors>(line, first, weights, factors, samples, shaped);                 \
  }

OCTASCOPE_SHAPE_LINE(shape_0_complex, 0, true)
OCTASCOPE_SHAPE_LINE(shape_4_complex, 4, true)
OCTASCOPE_SHAPE_LINE(shape_8_complex, 8, true)
OCTASCOPE_SHAPE_LINE(shape_0_real, 0, false)
OCTASCOPE_SHAPE_LINE(shape_4_real, 4, false)
OCTASCOPE_SHAPE_LINE(shape_8_real, 8, false)

OCTASCOPE_INLINE float bin_level_db(const float* bins, int depth) {
  const float re = bins[2 * depth];
  const float im = bins[2 * depth + 1];
  return fast_power_db(re * re + im * im);
}

} // namespace

OCTASCOPE_CPU_CLONES
std::uint32_t load_line(const std::uint8_t* counts, const float* background, int right_shift,
                        int samples, float* line) {
  return load_counts(counts, background, right_shift, samples, line);
}

OCTASCOPE_CPU_CLONES
std::uint32_t load_line(const std::uint16_t* counts, const float* background, int right_shift,
                        int samples, float* line) {
  return load_counts(counts, background, right_shift, samples, line);
}

OCTASCOPE_CPU_CLONES
std::uint32_t load_line(const float* counts, const float* background, int, int samples,
                        float* line) {
  for (int p = 0; p < samples; ++p)
    line[p] = counts[p] - background[p];
  return 0;
}

OCTASCOPE_CPU_CLONES
void sum_lines(const std::uint8_t* counts, int lines, int right_shift, int samples,
               std::uint32_t* sum) {
  sum_counts(counts, lines, right_shift, samples, sum);
}

OCTASCOPE_CPU_CLONES
void sum_lines(const std::uint16_t* counts, int lines, int right_shift, int samples,
               std::uint32_t* sum) {
  sum_counts(counts, lines, right_shift, samples, sum);
}

OCTASCOPE_CPU_CLONES
void sum_lines(const float* counts, int lines, int, int samples, double* sum) {
  sum_counts(counts, lines, 0, samples, sum);
}

OCTASCOPE_CPU_CLONES
bool add_line_below(const std::uint8_t* counts, std::uint32_t limit, int right_shift, int samples,
                    float* sum) {
  return add_counts_below(counts, limit, right_shift, samples, sum);
}

OCTASCOPE_CPU_CLONES
bool add_line_below(const std::uint16_t* counts, std::uint32_t limit, int right_shift, int samples,
                    float* sum) {
  return add_counts_below(counts, limit, right_shift, samples, sum);
}

OCTASCOPE_CPU_CLONES
bool add_line_below(const float* counts, std::uint32_t, int, int samples, float* sum) {
  for (int p = 0; p < samples; ++p)
    sum[p] += counts[p];
  return true;
}

ShapeLine shape_line_kernel(int taps_width, bool complex_factors) {
  if (taps_width == 8)
    return complex_factors ? &shape_8_complex : &shape_8_real;
  if (taps_width == 4)
    return complex_factors ? &shape_4_complex : &shape_4_real;
  return complex_factors ? &shape_0_complex : &shape_0_real;
}

OCTASCOPE_CPU_CLONES
void levels_db(const float* bins, int depths, float* levels) {
  for (int z = 0; z < depths; ++z)
    levels[z] = bin_level_db(bins, z);
}

OCTASCOPE_CPU_CLONES
void levels_u8(const float* bins, int depths, std::uint8_t* levels) {
  for (int z = 0; z < depths; ++z)
    levels[z] = fast_quantise_level(bin_level_db(bins, z));
}

} // namespace octascope::pipeline
