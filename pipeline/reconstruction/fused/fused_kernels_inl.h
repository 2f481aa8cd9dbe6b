// The passes of the fused reconstruction. For one instruction set; see fused_kernels.h and, for
// the numbering, fused_tables.h.
//
// First pass: counts, factors and radix 8 over the blocks. Middle passes in place. Last pass: the
// last radix over the blocks, the transform over the lanes, of which only bins below N/2 are made,
// and their powers, in rows; at the end the rows' levels are put in the order of depth. Or the bins
// themselves, in a row for their real and one for their imaginary parts.
//
// Real input (no dispersion phase): results 5, 6, 7 of the first radix are the conjugates of 3, 2,
// 1. They are neither stored nor transformed; instead results 1, 2, 3 are transformed to all their
// bins, of which the upper half are the missing ones, mirrored.
#if defined(OCTASCOPE_FUSED_KERNELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_FUSED_KERNELS_INL
#undef OCTASCOPE_FUSED_KERNELS_INL
#else
#define OCTASCOPE_FUSED_KERNELS_INL
#endif

#include <hwy/highway.h>

#include "pipeline/reconstruction/fused/fused_kernels.h"

#if HWY_TARGET == HWY_SCALAR // nothing to permute: FFTW's path serves such processors better

HWY_BEFORE_NAMESPACE();
namespace octascope::pipeline::HWY_NAMESPACE {

const FusedKernels* kernels() {
  return nullptr;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace octascope::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#else

#include <array>
#include <complex>
#include <type_traits>

#include <hwy/cache_control.h>

#include "pipeline/reconstruction/fused/fused_lanes_inl.h"
#include "pipeline/reconstruction/fused/fused_levels_inl.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::pipeline::HWY_NAMESPACE {

inline constexpr int slot = 2 * lanes; // floats of one complex register

// Of the first radix' results, those that real input needs.
inline constexpr int real_results = first_radix / 2 + 1;

HWY_INLINE void prefetch(const void* line, std::ptrdiff_t from, std::ptrdiff_t bytes) {
  constexpr std::ptrdiff_t cache_line = 64;
  for (std::ptrdiff_t at = from; at < from + bytes; at += cache_line)
    hwy::Prefetch(static_cast<const char*>(line) + at);
}

// `highest` so far, and the counts of a step of the first pass.
template <class Count>
HWY_INLINE hn::Vec<hn::ScalableTag<Count>> highest_of(const Count* counts, std::ptrdiff_t step,
                                                      hn::Vec<hn::ScalableTag<Count>> highest) {
  const hn::ScalableTag<Count> tag;
  constexpr int share = first_radix * lanes;
#pragma GCC unroll 4
  for (int p = 0; p < share; p += static_cast<int>(HWY_LANES(Count)))
    highest = hn::Max(highest, hn::LoadU(tag, counts + step * share + p));
  return highest;
}

template <class Count>
HWY_INLINE bool reaches(hn::Vec<hn::ScalableTag<Count>> highest, std::uint32_t threshold) {
  const hn::ScalableTag<Count> tag;
  const auto limit = hn::Set(tag, static_cast<Count>(threshold));
  return !hn::AllFalse(tag, hn::Eq(hn::Max(highest, limit), highest));
}

template <RawKind Kind, int Pairs, bool OneWindow, bool RealInput>
bool first_pass(const FusedTables& tables, const void* counts, const void* next_line,
                std::uint32_t threshold, const std::int32_t* background, float* work) {
  using Count = std::conditional_t<Kind == RawKind::u8, std::uint8_t, std::uint16_t>;
  constexpr int sample_bytes = sizeof(Count);
  constexpr int results = RealInput ? real_results : first_radix;
  const std::ptrdiff_t steps = tables.blocks / first_radix;
  const std::ptrdiff_t fetched = tables.samples * sample_bytes / steps;
  const float* twiddle = tables.pass_twiddles[0].data();
  auto highest = hn::Zero(hn::ScalableTag<Count>{});
  for (std::ptrdiff_t j = 0; j < steps; ++j, twiddle += 2 * (first_radix - 1)) {
    prefetch(next_line, j * fetched, fetched);
    highest = highest_of(static_cast<const Count*>(counts), j, highest);
    Real count[first_radix];
#pragma GCC unroll 8
    for (int a = 0; a < first_radix; ++a)
      count[a] = resample<Kind, Pairs, OneWindow>(tables, counts, background, j * first_radix + a);
    Complex x[first_radix];
    const float* factors = tables.factors.data();
    if constexpr (RealInput)
      real_butterfly(count, factors + j * first_radix * lanes, x);
    else
      weighted_butterfly(count, factors + j * first_radix * slot, x);
    float* at = work + j * slot;
    store(x[0], at);
#pragma GCC unroll 8
    for (int q = 1; q < results; ++q)
      store(x[q] * broadcast(twiddle + 2 * (q - 1)), at + q * steps * slot);
  }
  return reaches<Count>(highest, threshold);
}

// One pass over groups of `size` slots each.
template <int Radix>
HWY_INLINE void middle_pass(float* work, std::ptrdiff_t slots, std::ptrdiff_t size,
                            const float* twiddles) {
  const std::ptrdiff_t step = size / Radix * slot;
  for (std::ptrdiff_t group = 0; group < slots; group += size) {
    const float* twiddle = twiddles;
    for (std::ptrdiff_t j = 0; j < size / Radix; ++j) {
      float* at = work + (group + j) * slot;
      Complex x[std::size_t{Radix}];
#pragma GCC unroll 8
      for (int r = 0; r < Radix; ++r)
        x[r] = load(at + r * step);
      butterfly(x);
      store(x[0], at);
#pragma GCC unroll 8
      for (int q = 1; q < Radix; ++q, twiddle += 2)
        store(x[q] * broadcast(twiddle), at + q * step);
    }
  }
}

HWY_INLINE void store_reversed(Real value, std::size_t r, std::size_t registers, float* row) {
  hn::Store(hn::Reverse(Floats{}, value), Floats{}, row + (registers - 1 - r) * lanes);
}

// What is made of the bins of a group, in rows `stride` floats apart. Mirrored ones are the
// conjugates of bins of another row, backwards.
struct Powers {
  float* rows;
  int stride;

  template <std::size_t Registers>
  HWY_INLINE void put(const Complex (&y)[Registers], int row) const {
    store_power(y, rows + row * stride);
  }
  template <std::size_t Registers>
  HWY_INLINE void put_mirrored(const Complex (&y)[Registers], int row) const {
    alignas(64) float power[Registers * lanes];
    store_power(y, power);
    for (std::size_t r = 0; r < Registers; ++r)
      store_reversed(hn::Load(Floats{}, power + r * lanes), r, Registers, rows + row * stride);
  }
};

// And the bins that they are of, packed.
struct BinsAndPowers {
  using Packed = hn::Repartition<std::uint32_t, Floats>;

  std::uint32_t* bins;
  Powers powers;

  static HWY_INLINE hn::Vec<Packed> pack(Real re, Real im) {
    const Packed packed;
    const auto half_a_step = hn::Set(packed, PackedBin::half_a_step);
    const auto real = hn::Add(hn::BitCast(packed, re), half_a_step);
    const auto imaginary = hn::Add(hn::BitCast(packed, im), half_a_step);
    return hn::Or(hn::And(real, hn::Set(packed, PackedBin::upper_half)),
                  hn::ShiftRight<16>(imaginary));
  }

  template <std::size_t Registers>
  HWY_INLINE void put(const Complex (&y)[Registers], int row) const {
    for (std::size_t r = 0; r < Registers; ++r)
      hn::Store(pack(y[r].re, y[r].im), Packed{}, bins + row * powers.stride + r * lanes);
    powers.put(y, row);
  }
  template <std::size_t Registers>
  HWY_INLINE void put_mirrored(const Complex (&y)[Registers], int row) const {
    for (std::size_t r = 0; r < Registers; ++r)
      hn::Store(hn::Reverse(Packed{}, pack(y[r].re, hn::Neg(y[r].im))), Packed{},
                bins + row * powers.stride + (Registers - 1 - r) * lanes);
    powers.put_mirrored(y, row);
  }
};

// One group: the last radix, the lanes, the lower half of the bins. Mirrored: the upper half as well.
template <int Radix, bool Mirrored, class Ending>
HWY_INLINE void last_group(const FusedTables& tables, const float* from, const float* twiddles,
                           const Ending& ending, int row, int mirrored_row) {
  Complex x[std::size_t{Radix}];
#pragma GCC unroll 8
  for (int r = 0; r < Radix; ++r)
    x[r] = load(from + r * slot);
  butterfly(x);
#pragma GCC unroll 8
  for (int r = 0; r < Radix; ++r)
    x[r] = x[r] * load(twiddles + r * slot);
  transform_lanes(tables, x);
  Complex lower[std::size_t{Radix / 2}];
  Complex upper[std::size_t{Radix / 2}];
#pragma GCC unroll 8
  for (int r = 0; r < Radix / 2; ++r) {
    lower[r] = x[r / 2 * 4 + r % 2];
    upper[r] = x[r / 2 * 4 + r % 2 + 2];
  }
  ending.put(lower, row);
  if constexpr (Mirrored)
    ending.put_mirrored(upper, mirrored_row);
}

template <int Radix, class Ending>
HWY_INLINE void last_pass(const FusedTables& tables, const float* work, const Ending& ending) {
  const int groups = tables.blocks / Radix;
  const int groups_each = groups / first_radix; // of each of the first radix' results
  const int made = tables.real_input ? real_results * groups_each : groups;
  const int mirrored_from = tables.real_input ? groups_each : made;
  const int mirrored_to = tables.real_input ? made - groups_each : made;
  const float* twiddles = tables.last_twiddles.data();
  for (int group = 0; group < made; ++group, twiddles += Radix * slot) {
    const float* from = work + static_cast<std::ptrdiff_t>(group) * Radix * slot;
    const int row = tables.last_rows[static_cast<std::size_t>(group)];
    if (group < mirrored_from || group >= mirrored_to)
      last_group<Radix, false>(tables, from, twiddles, ending, row, 0);
    else
      last_group<Radix, true>(tables, from, twiddles, ending, row, groups - row);
  }
}

template <class Level> const std::int32_t* row_offsets(const FusedTables& tables) {
  return std::is_same_v<Level, float> ? tables.offsets_db.data() : tables.offsets_u8.data();
}

// The rest of the transform.
template <class Ending>
HWY_INLINE void transform(const FusedTables& tables, float* work, const Ending& ending) {
  const std::ptrdiff_t slots =
      tables.real_input ? tables.blocks / first_radix * real_results : tables.blocks;
  std::ptrdiff_t size = tables.blocks / first_radix;
  for (int pass = 1; pass + 1 < tables.passes; ++pass) {
    const auto at = static_cast<std::size_t>(pass);
    const float* twiddles = tables.pass_twiddles[at].data();
    if (tables.radices[at] == 8)
      middle_pass<8>(work, slots, size, twiddles);
    else
      middle_pass<4>(work, slots, size, twiddles);
    size /= tables.radices[at];
  }
  if (size == 8)
    last_pass<8>(tables, work, ending);
  else
    last_pass<4>(tables, work, ending);
}

template <class Level> void finish(const FusedTables& tables, float* work, Level* levels) {
  const bool ordered =
      std::is_same_v<Level, std::uint8_t> && ordered_blocks > 0 && tables.blocks == ordered_blocks;
  const int row_size = tables.last_radix() / 2 * lanes;
  // Where nothing else is written, each row takes the place of the group that it comes from: a line
  // touches less memory.
  const int stride = ordered ? tables.last_radix() * slot : row_size;
  float* power = ordered ? work : work + 2 * static_cast<std::ptrdiff_t>(tables.samples);
  transform(tables, work, Powers{power, stride});
  if (ordered)
    return make_ordered_levels(power, stride, levels);
  Level* rows = reinterpret_cast<Level*>(work); // which is no longer needed
  make_levels(power, tables.samples / 2, rows);
  for (int row = 0; row < tables.blocks / tables.last_radix(); row += 8)
    unscramble_rows(rows + row * row_size, row_size, row_offsets<Level>(tables), levels + row);
}

// A B-scan's bins do not fit into the second-level cache, and their order defeats what the processor
// fetches ahead by itself: each would be waited for when it is stored.
HWY_INLINE void expect_stores(const PackedBin* bins, int count) {
  constexpr int in_line = 64 / sizeof(PackedBin);
  for (int x = 0; x < count; x += in_line)
    __builtin_prefetch(bins + x, 1, 2);
}

// Levels of the rows of powers, as finish() has them.
void finish_both(const FusedTables& tables, float* work, const BinsAndLevels& both) {
  expect_stores(both.bins, tables.samples / 2);
  const int half = tables.samples / 2;
  const int row_size = tables.last_radix() / 2 * lanes;
  float* power = work + 2 * static_cast<std::ptrdiff_t>(tables.samples);
  auto* packed = reinterpret_cast<std::uint32_t*>(power + half);
  transform(tables, work, BinsAndPowers{packed, {power, row_size}});
  const int rows_end = tables.blocks / tables.last_radix();
  for (int row = 0; row < rows_end; row += 8)
    unscramble_bins(packed + row * row_size, row_size, tables.offsets_db.data(), both.bins + row);
  if (ordered_blocks > 0 && tables.blocks == ordered_blocks)
    return make_ordered_levels(power, row_size, both.levels);
  auto* rows = reinterpret_cast<std::uint8_t*>(work); // which is no longer needed
  make_levels(power, half, rows);
  for (int row = 0; row < rows_end; row += 8)
    unscramble_rows(rows + row * row_size, row_size, row_offsets<std::uint8_t>(tables),
                    both.levels + row);
}

template <RawKind Kind, int Pairs> constexpr FusedKernels::FirstPasses first_passes() {
  // Permutations by bytes cannot reach beyond their part.
  constexpr bool one_window = Pairs > 1 && !window_shape.byte_indices;
  return {
      {{&first_pass<Kind, Pairs, false, false>, &first_pass<Kind, Pairs, false, true>},
       {&first_pass<Kind, Pairs, one_window, false>, &first_pass<Kind, Pairs, one_window, true>}}};
}

template <RawKind Kind> constexpr std::array<FusedKernels::FirstPasses, 3> all_first_passes() {
  return {first_passes<Kind, 1>(), first_passes<Kind, 2>(), first_passes<Kind, 4>()};
}

const FusedKernels* kernels() {
  static const FusedKernels table{hwy::TargetName(HWY_TARGET),
                                  window_shape,
                                  {all_first_passes<RawKind::u8>(),
                                   all_first_passes<RawKind::u16>(),
                                   all_first_passes<RawKind::u16_shifted>()},
                                  &finish<std::uint8_t>,
                                  &finish<float>,
                                  &finish_both};
  return &table;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace octascope::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // HWY_SCALAR

#endif
