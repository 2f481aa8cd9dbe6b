// The passes of the fused reconstruction. For one instruction set; see fused_kernels.h.
//
// First pass, for each register of b: radix L over a, twiddle, transposition; then slot b of `work`
// holds lanes k2. Middle passes in place over the slots. Last pass: bins k2 + L·k1 in order, only
// those below N/2, straight to levels. (Four-step transform, then decimation in frequency.)
#if defined(OCTASCOPE_FUSED_KERNELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_FUSED_KERNELS_INL
#undef OCTASCOPE_FUSED_KERNELS_INL
#else
#define OCTASCOPE_FUSED_KERNELS_INL
#endif

#include <hwy/highway.h>

#include "pipeline/fused_kernels.h"

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

#include <algorithm>

#include <hwy/cache_control.h>

#include "pipeline/fast_level.h"
#include "pipeline/fused_butterflies_inl.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::pipeline::HWY_NAMESPACE {

inline constexpr int slot = 2 * lanes; // floats of one complex register

template <RawKind Kind, int Pairs>
void first_pass(const FusedTables& tables, const void* counts, const void* next_line,
                const std::int32_t* background, float* work) {
  constexpr std::ptrdiff_t line_bytes_per_block = lanes * (Kind == RawKind::u8 ? 1 : 2);
  const Floats floats;
  const std::ptrdiff_t blocks = tables.samples / lanes;
  const float* twiddles = tables.first_twiddles.data();
  for (std::ptrdiff_t first = 0; first < blocks; first += lanes) {
    Complex x[lanes];
    for (int a = 0; a < lanes; ++a) {
      const std::ptrdiff_t block = first + a;
      hwy::Prefetch(static_cast<const char*>(next_line) + block * line_bytes_per_block);
      const Real count = resample<Kind, Pairs>(tables, counts, background, block);
      const float* factor = tables.factors.data() + block * slot;
      x[a] = {hn::Mul(count, hn::Load(floats, factor)),
              hn::Mul(count, hn::Load(floats, factor + lanes))};
    }
    butterfly(x);
    Real re[lanes];
    Real im[lanes];
    for (int k2 = 0; k2 < lanes; ++k2) {
      const Complex turned = k2 == 0 ? x[k2] : x[k2] * load(twiddles + (first + k2) * slot);
      re[k2] = turned.re;
      im[k2] = turned.im;
    }
    transpose(re);
    transpose(im);
    for (int b = 0; b < lanes; ++b)
      store({re[b], im[b]}, work + (first + b) * slot);
  }
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
      for (int r = 0; r < Radix; ++r)
        x[r] = load(at + r * step);
      butterfly(x);
      store(x[0], at);
      for (int q = 1; q < Radix; ++q, twiddle += 2)
        store(x[q] * broadcast(twiddle), at + q * step);
    }
  }
}

// log2 of the power as in fast_log2(), by registers.
HWY_INLINE Real log2_power(const Complex& y) {
  const Floats floats;
  const Ints ints;
  const Real power = hn::MulAdd(y.re, y.re, hn::Mul(y.im, y.im));
  const auto bits = hn::BitCast(ints, power);
  const Real exponent =
      hn::ConvertTo(floats, hn::Sub(hn::ShiftRight<23>(bits), hn::Set(ints, 127)));
  const auto mantissa =
      hn::Or(hn::And(bits, hn::Set(ints, 0x007F'FFFF)), hn::Set(ints, 0x3F80'0000));
  const Real t = hn::Sub(hn::BitCast(floats, mantissa), hn::Set(floats, 1.0F));
  const Real q = hn::MulAdd(t, hn::MulAdd(t, hn::Set(floats, log2_c2), hn::Set(floats, log2_c1)),
                            hn::Set(floats, log2_c0));
  // t + t(1 − t)q
  return hn::Add(exponent, hn::MulAdd(hn::NegMulAdd(t, t, t), q, t));
}

HWY_INLINE void put_level(const Complex& y, float* level) {
  const Floats floats;
  hn::StoreU(hn::Mul(log2_power(y), hn::Set(floats, db_per_octave_of_power)), floats, level);
}

HWY_INLINE void put_level(const Complex& y, std::uint8_t* level) {
  const Floats floats;
  constexpr float counts_per_octave = db_per_octave_of_power / level_step_db;
  constexpr float zero_db = level_count(0.0F);
  const Real count =
      hn::MulAdd(log2_power(y), hn::Set(floats, counts_per_octave), hn::Set(floats, zero_db));
  const hn::Rebind<std::uint8_t, Floats> bytes;
  hn::StoreU(hn::DemoteTo(bytes, hn::NearestInt(count)), bytes, level);
}

template <int Radix, class Level>
HWY_INLINE void last_pass(const FusedTables& tables, const float* work, Level* levels) {
  const std::ptrdiff_t slots = tables.samples / lanes;
  const std::ptrdiff_t groups = slots / Radix;
  for (std::ptrdiff_t group = 0; group < groups; ++group) {
    const float* at = work + group * Radix * slot;
    Level* to = levels + tables.last_offsets[static_cast<std::size_t>(group)] * lanes;
    Complex x[std::size_t{Radix}];
    for (int r = 0; r < Radix; ++r)
      x[r] = load(at + r * slot);
    if constexpr (Radix == 8) {
      Complex even[4];
      Complex odd[4];
      half_butterfly_8(x, even, odd);
      for (int p = 0; p < 4; ++p)
        put_level(even[p] + odd[p], to + p * groups * lanes);
    } else {
      const Complex difference = x[1] - x[3];
      put_level((x[0] + x[2]) + (x[1] + x[3]), to);
      put_level(minus_i(x[0] - x[2], difference), to + groups * lanes);
    }
  }
}

template <class Level> void finish(const FusedTables& tables, float* work, Level* levels) {
  const std::ptrdiff_t slots = tables.samples / lanes;
  std::ptrdiff_t size = slots;
  for (int pass = 0; pass + 1 < tables.passes; ++pass) {
    const auto at = static_cast<std::size_t>(pass);
    const float* twiddles = tables.pass_twiddles[at].data();
    if (tables.radices[at] == 8)
      middle_pass<8>(work, slots, size, twiddles);
    else
      middle_pass<4>(work, slots, size, twiddles);
    size /= tables.radices[at];
  }
  if (size == 8)
    last_pass<8>(tables, work, levels);
  else
    last_pass<4>(tables, work, levels);
}

template <class Count> std::uint32_t highest_count(const Count* counts, int samples) {
  const hn::ScalableTag<Count> tag;
  constexpr int step = static_cast<int>(HWY_LANES(Count));
  auto highest = hn::Zero(tag);
  for (int p = 0; p < samples; p += step)
    highest = hn::Max(highest, hn::LoadU(tag, counts + p));
  alignas(64) Count lane[HWY_LANES(Count)];
  hn::Store(highest, tag, lane);
  return *std::max_element(lane, lane + step);
}

const FusedKernels* kernels() {
#define OCTASCOPE_FIRST_PASSES(kind)                                                               \
  { &first_pass<kind, 1>, &first_pass<kind, 2>, &first_pass<kind, 4> }
  static const FusedKernels table{hwy::TargetName(HWY_TARGET),
                                  window_shape,
                                  {OCTASCOPE_FIRST_PASSES(RawKind::u8),
                                   OCTASCOPE_FIRST_PASSES(RawKind::u16),
                                   OCTASCOPE_FIRST_PASSES(RawKind::u16_shifted)},
                                  &finish<std::uint8_t>,
                                  &finish<float>,
                                  &highest_count<std::uint8_t>,
                                  &highest_count<std::uint16_t>};
#undef OCTASCOPE_FIRST_PASSES
  return &table;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace octascope::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // HWY_SCALAR

#endif
