// Resampling of raw counts inside registers: a window of neighbouring samples is loaded once and
// permuted into tap pairs, so that no sample is gathered from memory one by one. For one
// instruction set; see fused_kernels.h.
#if defined(OCTASCOPE_FUSED_RESAMPLE_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_FUSED_RESAMPLE_INL
#undef OCTASCOPE_FUSED_RESAMPLE_INL
#else
#define OCTASCOPE_FUSED_RESAMPLE_INL
#endif

#include <cstdint>

#include <hwy/highway.h>

#include "pipeline/reconstruction/fused/fused_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::pipeline::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::ScalableTag<std::int32_t>;
using Words = hn::ScalableTag<std::int16_t>;
using UnsignedWords = hn::ScalableTag<std::uint16_t>;
using Real = hn::Vec<Floats>;

inline constexpr int lanes = static_cast<int>(HWY_LANES(float));

#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86
inline constexpr WindowShape window_shape{lanes, lanes, 2 * lanes, false};
#else
inline constexpr WindowShape window_shape{lanes, 4, 8, true}; // one in each 128-bit part
#endif
inline constexpr int windows_per_block = lanes / window_shape.outputs;

// `samples` raw samples from `at` as signed words: u8 as they are, u16 less 32768 or shifted.
template <RawKind Kind, class Tag>
HWY_INLINE hn::Vec<Tag> load_samples(Tag words, const void* counts, std::int32_t at, int shift) {
  const hn::RebindToUnsigned<Tag> unsigned_words;
  if constexpr (Kind == RawKind::u8) {
    const hn::Rebind<std::uint8_t, Tag> bytes;
    return hn::PromoteTo(words, hn::LoadU(bytes, static_cast<const std::uint8_t*>(counts) + at));
  } else {
    const auto raw = hn::LoadU(unsigned_words, static_cast<const std::uint16_t*>(counts) + at);
    if constexpr (Kind == RawKind::u16_shifted)
      return hn::BitCast(words, hn::ShiftRightSame(raw, shift));
    else
      return hn::BitCast(words, hn::Xor(raw, hn::Set(unsigned_words, std::uint16_t{0x8000})));
  }
}

// The windows of one block, `starts` holding one for each of the parts of a register.
template <RawKind Kind>
HWY_INLINE hn::Vec<Words> load_windows(const void* counts, const std::int32_t* starts, int ahead,
                                       int shift) {
  const Words words;
#if HWY_MAX_BYTES == 32
  const hn::Half<Words> half;
  return hn::Combine(words, load_samples<Kind>(half, counts, starts[1] + ahead, shift),
                     load_samples<Kind>(half, counts, starts[0] + ahead, shift));
#else
  static_assert(windows_per_block == 1);
  return load_samples<Kind>(words, counts, starts[0] + ahead, shift);
#endif
}

HWY_INLINE hn::Vec<Words> permute(hn::Vec<Words> window, hn::Vec<Words> permutation) {
#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86
  return hn::Vec<Words>{_mm512_permutexvar_epi16(permutation.raw, window.raw)};
#else
  return hn::TableLookupBytes(window, permutation);
#endif
}

// L interpolated counts less their background, times 2^14: block `block` in the tables' order. The
// taps of the second and further pairs come out of windows of their own, two samples on each, or
// out of the first one where it holds all of them.
template <RawKind Kind, int Pairs, bool OneWindow>
HWY_INLINE Real resample(const FusedTables& tables, const void* counts,
                         const std::int32_t* background, std::ptrdiff_t block) {
  const Words words;
  const Ints ints;
  const std::int32_t* starts = tables.window_starts.data() + block * windows_per_block;
  auto permutation = hn::Load(
      words, reinterpret_cast<const std::int16_t*>(tables.permutations.data()) + block * 2 * lanes);
  const std::int16_t* weights = tables.weights.data() + block * 2 * lanes * Pairs;
  auto even = hn::Zero(ints); // which lane of which sum a tap adds to differs from set to set …
  auto odd = hn::Zero(ints);
  auto window = load_windows<Kind>(counts, starts, 0, tables.right_shift);
#pragma GCC unroll 4
  for (int pair = 0; pair < Pairs; ++pair) {
    if (pair > 0 && OneWindow)
      permutation = hn::Add(permutation, hn::Set(words, std::int16_t{2}));
    else if (pair > 0)
      window = load_windows<Kind>(counts, starts, 2 * pair, tables.right_shift);
    even = hn::ReorderWidenMulAccumulate(ints, permute(window, permutation),
                                         hn::Load(words, weights + pair * 2 * lanes), even, odd);
  }
  const auto sum = hn::RearrangeToOddPlusEven(even, odd); // … until here
  return hn::ConvertTo(Floats{}, hn::Sub(sum, hn::Load(ints, background + block * lanes)));
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace octascope::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
