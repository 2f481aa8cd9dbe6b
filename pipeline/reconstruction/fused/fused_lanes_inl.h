// The transform over the lanes of a register, for four registers (four results k1) at a time. For
// one instruction set; see fused_kernels.h.
#if defined(OCTASCOPE_FUSED_LANES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_FUSED_LANES_INL
#undef OCTASCOPE_FUSED_LANES_INL
#else
#define OCTASCOPE_FUSED_LANES_INL
#endif

#include "pipeline/reconstruction/fused/fused_butterflies_inl.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::pipeline::HWY_NAMESPACE {

inline constexpr int parts = lanes / 4; // of 128 bits

// Transposes the 4×4 squares inside each 128-bit part of four registers.
HWY_INLINE void transpose_lanes(Real& r0, Real& r1, Real& r2, Real& r3) {
  const Floats floats;
  const hn::Repartition<double, Floats> doubles;
  const auto pair = [&](Real v) HWY_ATTR { return hn::BitCast(doubles, v); };
  const auto a = pair(hn::InterleaveLower(floats, r0, r1));
  const auto b = pair(hn::InterleaveUpper(floats, r0, r1));
  const auto c = pair(hn::InterleaveLower(floats, r2, r3));
  const auto d = pair(hn::InterleaveUpper(floats, r2, r3));
  r0 = hn::BitCast(floats, hn::InterleaveLower(doubles, a, c));
  r1 = hn::BitCast(floats, hn::InterleaveUpper(doubles, a, c));
  r2 = hn::BitCast(floats, hn::InterleaveLower(doubles, b, d));
  r3 = hn::BitCast(floats, hn::InterleaveUpper(doubles, b, d));
}

#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86

// Part p of register r changes places with part r of register p.
HWY_INLINE void transpose_parts(Real& r0, Real& r1, Real& r2, Real& r3) {
  const __m512 low01 = _mm512_shuffle_f32x4(r0.raw, r1.raw, 0x44);
  const __m512 high01 = _mm512_shuffle_f32x4(r0.raw, r1.raw, 0xEE);
  const __m512 low23 = _mm512_shuffle_f32x4(r2.raw, r3.raw, 0x44);
  const __m512 high23 = _mm512_shuffle_f32x4(r2.raw, r3.raw, 0xEE);
  r0 = Real{_mm512_shuffle_f32x4(low01, low23, 0x88)};
  r1 = Real{_mm512_shuffle_f32x4(low01, low23, 0xDD)};
  r2 = Real{_mm512_shuffle_f32x4(high01, high23, 0x88)};
  r3 = Real{_mm512_shuffle_f32x4(high01, high23, 0xDD)};
}

// Radix 4 over the parts of x[0] to x[3]: x[v], part r comes from what was x[r].
HWY_INLINE void transform_parts(const FusedTables& tables, Complex* x) {
  transpose_parts(x[0].re, x[1].re, x[2].re, x[3].re);
  transpose_parts(x[0].im, x[1].im, x[2].im, x[3].im);
  butterfly_4(x[0], x[1], x[2], x[3]);
  for (int v = 1; v < 4; ++v)
    x[v] = x[v] * load(tables.lane_twiddles.data() + (v - 1) * 2 * lanes);
}

#elif HWY_MAX_BYTES == 32

// Radix 2 over the parts of x[0] and x[1], and of x[2] and x[3]: x[v], part p comes from what was
// x[p].
HWY_INLINE void transform_parts(const FusedTables& tables, Complex* x) {
  const Floats floats;
  const Complex twiddle = load(tables.lane_twiddles.data());
  for (int pair = 0; pair < 4; pair += 2) {
    const Complex low = {hn::ConcatLowerLower(floats, x[pair + 1].re, x[pair].re),
                         hn::ConcatLowerLower(floats, x[pair + 1].im, x[pair].im)};
    const Complex high = {hn::ConcatUpperUpper(floats, x[pair + 1].re, x[pair].re),
                          hn::ConcatUpperUpper(floats, x[pair + 1].im, x[pair].im)};
    x[pair] = low + high;
    x[pair + 1] = (low - high) * twiddle;
  }
}

#else

HWY_INLINE void transform_parts(const FusedTables&, Complex*) {
  static_assert(parts == 1);
}

#endif

// The L-point transform over the lanes of each of the registers, four by four: x[u] becomes the
// outputs k2 = v + L/4·u. Lane i of each part: v = i with four parts, i mod 2 with two, 0 with one;
// the rest of the position says which of the four registers: the part; the part + i/2·2; i.
// (Four-step transforms within a register: first over the parts, then over the four lanes of each.)
template <std::size_t Registers>
HWY_INLINE void transform_lanes(const FusedTables& tables, Complex (&x)[Registers]) {
#pragma GCC unroll 2
  for (std::size_t r = 0; r < Registers; r += 4)
    transform_parts(tables, x + r);
#pragma GCC unroll 2
  for (std::size_t r = 0; r < Registers; r += 4) {
    transpose_lanes(x[r].re, x[r + 1].re, x[r + 2].re, x[r + 3].re);
    transpose_lanes(x[r].im, x[r + 1].im, x[r + 2].im, x[r + 3].im);
  }
#pragma GCC unroll 2
  for (std::size_t r = 0; r < Registers; r += 4)
    butterfly_4(x[r], x[r + 1], x[r + 2], x[r + 3]);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace octascope::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
