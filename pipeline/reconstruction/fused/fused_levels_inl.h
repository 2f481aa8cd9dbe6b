// Complex bins → levels, and rows of levels → a profile. For one instruction set; see
// fused_kernels.h.
#if defined(OCTASCOPE_FUSED_LEVELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_FUSED_LEVELS_INL
#undef OCTASCOPE_FUSED_LEVELS_INL
#else
#define OCTASCOPE_FUSED_LEVELS_INL
#endif

#include <cstring>

#include "pipeline/reconstruction/fused/fast_level.h"
#include "pipeline/reconstruction/fused/fused_butterflies_inl.h"
#include "pipeline/volume/packed_bin.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::pipeline::HWY_NAMESPACE {

// |y|² of some registers, one after the other.
template <std::size_t Registers>
HWY_INLINE void store_power(const Complex (&y)[Registers], float* power) {
#pragma GCC unroll 8
  for (std::size_t r = 0; r < Registers; ++r)
    hn::Store(hn::MulAdd(y[r].re, y[r].re, hn::Mul(y[r].im, y[r].im)), Floats{}, power + r * lanes);
}

// per_octave·log2(power) + zero, as fast_log2() has it: the bits of a float, taken for an integer,
// are its logarithm but for a function of the mantissa, which a polynomial adds. Step by step for
// all registers: compilers keep this order, and one register alone would wait for itself.
template <std::size_t Registers>
HWY_INLINE void load_levels(const float* power, float per_octave, float zero,
                            Real (&level)[Registers]) {
  const Floats floats;
  const Ints ints;
  Real mantissa[Registers];
  Real exponent[Registers];
#pragma GCC unroll 8
  for (std::size_t r = 0; r < Registers; ++r) {
    const auto bits = hn::BitCast(ints, hn::Load(floats, power + r * lanes));
    exponent[r] = hn::ConvertTo(floats, bits);
    mantissa[r] = hn::BitCast(
        floats, hn::Or(hn::And(bits, hn::Set(ints, 0x007F'FFFF)), hn::Set(ints, 0x3F80'0000)));
    level[r] = hn::Set(floats, per_octave * log2_of_mantissa[4]);
  }
#pragma GCC unroll 4
  for (int i = 3; i >= 0; --i) {
    const Real coefficient =
        hn::Set(floats, per_octave * log2_of_mantissa[static_cast<std::size_t>(i)] +
                            (i == 0 ? zero : 0.0F));
#pragma GCC unroll 8
    for (std::size_t r = 0; r < Registers; ++r)
      level[r] = hn::MulAdd(mantissa[r], level[r], coefficient);
  }
  const Real scale = hn::Set(floats, per_octave / (1 << 23));
#pragma GCC unroll 8
  for (std::size_t r = 0; r < Registers; ++r)
    level[r] = hn::MulAdd(exponent[r], scale, level[r]);
}

// Rounded, for values that are known to fit: hn::NearestInt() also fixes those that do not.
HWY_INLINE hn::Vec<Ints> nearest(Real value) {
#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86
  return hn::Vec<Ints>{_mm512_cvtps_epi32(value.raw)};
#elif HWY_MAX_BYTES == 32
  return hn::Vec<Ints>{_mm256_cvtps_epi32(value.raw)};
#elif HWY_TARGET == HWY_SSE4
  return hn::Vec<Ints>{_mm_cvtps_epi32(value.raw)};
#else
  return hn::NearestInt(value);
#endif
}

inline constexpr std::size_t registers_at_once = 4;

// Levels in decibels of `count` powers.
HWY_INLINE void make_levels(const float* power, int count, float* levels) {
  constexpr int step = static_cast<int>(registers_at_once) * lanes;
  for (int x = 0; x < count; x += step) {
    Real level[registers_at_once];
    load_levels(power + x, db_per_octave_of_power, 0, level);
    for (std::size_t r = 0; r < registers_at_once; ++r)
      hn::Store(level[r], Floats{}, levels + x + r * lanes);
  }
}

// Levels in counts, as yet unrounded.
HWY_INLINE void load_counts(const float* power, Real (&level)[registers_at_once]) {
  constexpr float counts_per_octave = db_per_octave_of_power / level_step_db;
  constexpr float zero_db = level_count(0.0F);
  load_levels(power, counts_per_octave, zero_db, level);
}

// Levels in counts: of two registers each, the parts of 128 bits in turns.
HWY_INLINE void make_levels(const float* power, int count, std::uint8_t* levels) {
  const hn::Rebind<std::uint8_t, Words> bytes;
  constexpr int step = static_cast<int>(registers_at_once) * lanes;
  for (int x = 0; x < count; x += step) {
    Real level[registers_at_once];
    load_counts(power + x, level);
#pragma GCC unroll 4
    for (std::size_t r = 0; r < registers_at_once; r += 2) {
      const auto words = hn::ReorderDemote2To(Words{}, nearest(level[r]), nearest(level[r + 1]));
      hn::Store(hn::DemoteTo(bytes, words), bytes, levels + x + r * lanes);
    }
  }
}

// Whether make_ordered_levels() serves lines of so many blocks: the last pass then has radix 8, and
// its rows are eight of four registers.
inline constexpr int ordered_blocks = HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86 ? first_radix * 8 : 0;

#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86

// Eight rows of powers, `stride` floats apart → the levels of a line in the order of depth, without
// rows of levels between.
HWY_INLINE void make_ordered_levels(const float* power, int stride, std::uint8_t* levels) {
  __m512i row[8]; // [part of 128 bits][group of four results][v, u: eight bins]
#pragma GCC unroll 8
  for (int q = 0; q < 8; ++q) {
    Real value[registers_at_once];
    load_counts(power + std::ptrdiff_t{q} * stride, value);
    row[q] = _mm512_packus_epi16(_mm512_packs_epi32(nearest(value[0]).raw, nearest(value[1]).raw),
                                 _mm512_packs_epi32(nearest(value[2]).raw, nearest(value[3]).raw));
  }
  __m512i column[2][4]; // [group][pair of bins]: [part][bin][row]
  for (int group = 0; group < 2; ++group) {
    __m512i pair[4];
    for (int i = 0; i < 4; ++i)
      pair[i] = group == 0 ? _mm512_unpacklo_epi8(row[2 * i], row[2 * i + 1])
                           : _mm512_unpackhi_epi8(row[2 * i], row[2 * i + 1]);
    const __m512i four[2][2] = {
        {_mm512_unpacklo_epi16(pair[0], pair[1]), _mm512_unpackhi_epi16(pair[0], pair[1])},
        {_mm512_unpacklo_epi16(pair[2], pair[3]), _mm512_unpackhi_epi16(pair[2], pair[3])}};
    for (int i = 0; i < 2; ++i) {
      column[group][2 * i] = _mm512_unpacklo_epi32(four[0][i], four[1][i]);
      column[group][2 * i + 1] = _mm512_unpackhi_epi32(four[0][i], four[1][i]);
    }
  }
  const __m512i even = _mm512_setr_epi64(0, 2, 4, 6, 8, 10, 12, 14);
  const __m512i odd = _mm512_setr_epi64(1, 3, 5, 7, 9, 11, 13, 15);
  for (int i = 0; i < 4; ++i) {
    const __m512i& low = column[0][i];
    const __m512i& high = column[1][i];
    _mm512_storeu_si512(levels + 128 * i, _mm512_permutex2var_epi64(low, even, high));
    _mm512_storeu_si512(levels + 128 * i + 64, _mm512_permutex2var_epi64(low, odd, high));
  }
}

#else

HWY_INLINE void make_ordered_levels(const float*, int, std::uint8_t*) {}

#endif

HWY_INLINE void make_ordered_levels(const float*, int, float*) {}

HWY_INLINE void store_halves(hn::Vec<hn::Full128<std::uint8_t>> both, std::uint8_t* lower,
                             std::uint8_t* upper) {
  const hn::Full64<std::uint8_t> eight;
  hn::StoreU(hn::LowerHalf(eight, both), eight, lower);
#if HWY_ARCH_X86 && HWY_TARGET != HWY_EMU128 // where UpperHalf() takes a shuffle
  _mm_storeh_pd(reinterpret_cast<double*>(upper), _mm_castsi128_pd(both.raw));
#else
  hn::StoreU(hn::UpperHalf(eight, both), eight, upper);
#endif
}

// Eight rows of `size` levels, from row q on → eight neighbouring bins at each offset.
template <class Level>
HWY_INLINE void unscramble_one_by_one(const Level* rows, int size, const std::int32_t* offsets,
                                      Level* levels) {
  for (int x = 0; x < size; ++x)
    for (int q = 0; q < 8; ++q)
      levels[offsets[x] + q] = rows[q * size + x];
}

HWY_INLINE void unscramble_rows(const float* rows, int size, const std::int32_t* offsets,
                                float* levels) {
  unscramble_one_by_one(rows, size, offsets, levels);
}

HWY_INLINE void unscramble_rows(const std::uint8_t* rows, int size, const std::int32_t* offsets,
                                std::uint8_t* levels) {
  const hn::Full128<std::uint8_t> bytes;
  const hn::Full128<std::uint16_t> words;
  const hn::Full128<std::uint32_t> quads;
  using Bytes = hn::Vec<hn::Full128<std::uint8_t>>;
  if (size < 16) { // four lanes and radix 4
    unscramble_one_by_one(rows, size, offsets, levels);
    return;
  }
  for (int x = 0; x < size; x += 16) {
    Bytes pair[2][4]; // bytes of rows 2i and 2i + 1
    for (int i = 0; i < 4; ++i) {
      const Bytes a = hn::Load(bytes, rows + 2 * i * size + x);
      const Bytes b = hn::Load(bytes, rows + (2 * i + 1) * size + x);
      pair[0][i] = hn::InterleaveLower(bytes, a, b);
      pair[1][i] = hn::InterleaveUpper(bytes, a, b);
    }
    for (int h = 0; h < 2; ++h) {
      const auto as_words = [&](int i) HWY_ATTR { return hn::BitCast(words, pair[h][i]); };
      const auto four = [&](int i, bool upper) HWY_ATTR {
        return hn::BitCast(quads, upper ? hn::InterleaveUpper(words, as_words(i), as_words(i + 1))
                                        : hn::InterleaveLower(words, as_words(i), as_words(i + 1)));
      };
      for (int upper = 0; upper < 2; ++upper) {
        const auto first = four(0, upper != 0);
        const auto second = four(2, upper != 0);
        const Bytes low = hn::BitCast(bytes, hn::InterleaveLower(quads, first, second));
        const Bytes high = hn::BitCast(bytes, hn::InterleaveUpper(quads, first, second));
        const std::int32_t* offset = offsets + x + 8 * h + 4 * upper;
        store_halves(low, levels + offset[0], levels + offset[1]);
        store_halves(high, levels + offset[2], levels + offset[3]);
      }
    }
  }
}

// Likewise of packed bins.
HWY_INLINE void unscramble_bins(const std::uint32_t* rows, int size, const std::int32_t* offsets,
                                PackedBin* bins) {
  const hn::Full128<std::uint32_t> four;
  const hn::Full128<std::uint64_t> two;
  auto* out = reinterpret_cast<std::uint32_t*>(bins);
  for (int x = 0; x < size; x += 4)
    for (int q = 0; q < 8; q += 4) {
      const auto row = [&](int r) HWY_ATTR { return hn::Load(four, rows + (q + r) * size + x); };
      const auto pairs = [&](int r, bool upper) HWY_ATTR {
        return hn::BitCast(two, upper ? hn::InterleaveUpper(four, row(r), row(r + 1))
                                      : hn::InterleaveLower(four, row(r), row(r + 1)));
      };
      for (int upper = 0; upper < 2; ++upper) {
        const auto first = pairs(0, upper != 0);
        const auto second = pairs(2, upper != 0);
        const std::int32_t* offset = offsets + x + 2 * upper;
        hn::StoreU(hn::BitCast(four, hn::InterleaveLower(two, first, second)), four,
                   out + offset[0] + q);
        hn::StoreU(hn::BitCast(four, hn::InterleaveUpper(two, first, second)), four,
                   out + offset[1] + q);
      }
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace octascope::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
