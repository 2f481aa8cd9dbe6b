// Butterflies of the fused transform and the transposition of a square of registers. For one
// instruction set; see fused_kernels.h.
#if defined(OCTASCOPE_FUSED_BUTTERFLIES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_FUSED_BUTTERFLIES_INL
#undef OCTASCOPE_FUSED_BUTTERFLIES_INL
#else
#define OCTASCOPE_FUSED_BUTTERFLIES_INL
#endif

#include "pipeline/fused_resample_inl.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::pipeline::HWY_NAMESPACE {

// L complex numbers.
struct Complex {
  Real re;
  Real im;
};

HWY_INLINE Complex operator+(const Complex& a, const Complex& b) {
  return {hn::Add(a.re, b.re), hn::Add(a.im, b.im)};
}
HWY_INLINE Complex operator-(const Complex& a, const Complex& b) {
  return {hn::Sub(a.re, b.re), hn::Sub(a.im, b.im)};
}
HWY_INLINE Complex operator*(const Complex& a, const Complex& b) {
  return {hn::NegMulAdd(a.im, b.im, hn::Mul(a.re, b.re)),
          hn::MulAdd(a.im, b.re, hn::Mul(a.re, b.im))};
}
// a − i·b and a + i·b.
HWY_INLINE Complex minus_i(const Complex& a, const Complex& b) {
  return {hn::Add(a.re, b.im), hn::Sub(a.im, b.re)};
}
HWY_INLINE Complex plus_i(const Complex& a, const Complex& b) {
  return {hn::Sub(a.re, b.im), hn::Add(a.im, b.re)};
}

HWY_INLINE Complex load(const float* from) {
  const Floats floats;
  return {hn::Load(floats, from), hn::Load(floats, from + lanes)};
}
HWY_INLINE void store(const Complex& value, float* to) {
  const Floats floats;
  hn::Store(value.re, floats, to);
  hn::Store(value.im, floats, to + lanes);
}
// One number for all lanes.
HWY_INLINE Complex broadcast(const float* from) {
  const Floats floats;
  return {hn::Set(floats, from[0]), hn::Set(floats, from[1])};
}
HWY_INLINE Complex broadcast(double re, double im) {
  const Floats floats;
  return {hn::Set(floats, static_cast<float>(re)), hn::Set(floats, static_cast<float>(im))};
}

// x[q] ← Σ_r x[r]·exp(−2πi·qr/4).
HWY_INLINE void butterfly_4(Complex& x0, Complex& x1, Complex& x2, Complex& x3) {
  const Complex a = x0 + x2;
  const Complex b = x0 - x2;
  const Complex c = x1 + x3;
  const Complex d = x1 - x3;
  x0 = a + c;
  x1 = minus_i(b, d);
  x2 = a - c;
  x3 = plus_i(b, d);
}

// The radix-8 butterfly up to its last additions: output q is even[q] + odd[q], output q + 4 their
// difference.
HWY_INLINE void half_butterfly_8(const Complex (&x)[8], Complex (&even)[4], Complex (&odd)[4]) {
  for (int i = 0; i < 4; ++i) {
    even[i] = x[2 * i];
    odd[i] = x[2 * i + 1];
  }
  butterfly_4(even[0], even[1], even[2], even[3]);
  butterfly_4(odd[0], odd[1], odd[2], odd[3]);
  const Real half = hn::Set(Floats{}, 0.70710678F);
  const Complex t1 = odd[1]; // times (1 − i)/√2
  odd[1] = {hn::Mul(half, hn::Add(t1.re, t1.im)), hn::Mul(half, hn::Sub(t1.im, t1.re))};
  odd[2] = {odd[2].im, hn::Neg(odd[2].re)};
  const Complex t3 = odd[3]; // times (−1 − i)/√2
  odd[3] = {hn::Mul(half, hn::Sub(t3.im, t3.re)), hn::Neg(hn::Mul(half, hn::Add(t3.re, t3.im)))};
}

HWY_INLINE void butterfly(Complex (&x)[4]) {
  butterfly_4(x[0], x[1], x[2], x[3]);
}

HWY_INLINE void butterfly(Complex (&x)[8]) {
  Complex even[4];
  Complex odd[4];
  half_butterfly_8(x, even, odd);
  for (int q = 0; q < 4; ++q) {
    x[q] = even[q] + odd[q];
    x[q + 4] = even[q] - odd[q];
  }
}

HWY_INLINE void butterfly(Complex (&x)[16]) {
  constexpr double c = 0.92387953251128674; // cos π/8
  constexpr double s = 0.38268343236508977;
  constexpr double h = 0.70710678118654752;
  for (int g = 0; g < 4; ++g)
    butterfly_4(x[g], x[g + 4], x[g + 8], x[g + 12]);
  // x[g + 4q] times exp(−2πi·gq/16)
  x[5] = x[5] * broadcast(c, -s);
  x[6] = x[6] * broadcast(h, -h);
  x[7] = x[7] * broadcast(s, -c);
  x[9] = x[9] * broadcast(h, -h);
  x[10] = {x[10].im, hn::Neg(x[10].re)};
  x[11] = x[11] * broadcast(-h, -h);
  x[13] = x[13] * broadcast(s, -c);
  x[14] = x[14] * broadcast(-h, -h);
  x[15] = x[15] * broadcast(-c, s);
  for (int q = 0; q < 4; ++q)
    butterfly_4(x[4 * q], x[4 * q + 1], x[4 * q + 2], x[4 * q + 3]);
  for (int q = 0; q < 4; ++q) // output q + 4p lies at 4q + p: exchange
    for (int p = 0; p < q; ++p) {
      const Complex kept = x[4 * q + p];
      x[4 * q + p] = x[4 * p + q];
      x[4 * p + q] = kept;
    }
}

// Transposes the 4×4 squares inside each 128-bit part of four registers.
HWY_INLINE void transpose_parts(Real& r0, Real& r1, Real& r2, Real& r3) {
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

// Lane j of register i changes places with lane i of register j.
HWY_INLINE void transpose(Real (&r)[lanes]) {
  for (int i = 0; i < lanes; i += 4)
    transpose_parts(r[i], r[i + 1], r[i + 2], r[i + 3]);
#if HWY_TARGET <= HWY_AVX3 && HWY_ARCH_X86
  for (int i = 0; i < 4; ++i) {
    const __m512 low01 = _mm512_shuffle_f32x4(r[i].raw, r[i + 4].raw, 0x44);
    const __m512 high01 = _mm512_shuffle_f32x4(r[i].raw, r[i + 4].raw, 0xEE);
    const __m512 low23 = _mm512_shuffle_f32x4(r[i + 8].raw, r[i + 12].raw, 0x44);
    const __m512 high23 = _mm512_shuffle_f32x4(r[i + 8].raw, r[i + 12].raw, 0xEE);
    r[i] = Real{_mm512_shuffle_f32x4(low01, low23, 0x88)};
    r[i + 4] = Real{_mm512_shuffle_f32x4(low01, low23, 0xDD)};
    r[i + 8] = Real{_mm512_shuffle_f32x4(high01, high23, 0x88)};
    r[i + 12] = Real{_mm512_shuffle_f32x4(high01, high23, 0xDD)};
  }
#elif HWY_MAX_BYTES == 32
  for (int i = 0; i < 4; ++i) {
    const Real low = r[i];
    r[i] = hn::ConcatLowerLower(Floats{}, r[i + 4], low);
    r[i + 4] = hn::ConcatUpperUpper(Floats{}, r[i + 4], low);
  }
#endif
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace octascope::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
