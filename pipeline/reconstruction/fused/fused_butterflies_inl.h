// Complex registers and the butterflies of the fused transform. For one instruction set; see
// fused_kernels.h.
#if defined(OCTASCOPE_FUSED_BUTTERFLIES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_FUSED_BUTTERFLIES_INL
#undef OCTASCOPE_FUSED_BUTTERFLIES_INL
#else
#define OCTASCOPE_FUSED_BUTTERFLIES_INL
#endif

#include "pipeline/reconstruction/fused/fused_resample_inl.h"

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

// The last two of the three steps of a radix-8 butterfly: s[a] = x[a] + x[a+4] and
// d[a] = x[a] − x[a+4] become x[q].
HWY_INLINE void finish_butterfly_8(Complex (&s)[4], Complex (&d)[4], Complex (&x)[8]) {
  const Real half = hn::Set(Floats{}, 0.70710678F);
  const Complex d1 = d[1]; // times (1 − i)/√2
  d[1] = {hn::Mul(half, hn::Add(d1.re, d1.im)), hn::Mul(half, hn::Sub(d1.im, d1.re))};
  d[2] = {d[2].im, hn::Neg(d[2].re)};
  const Complex d3 = d[3]; // times (−1 − i)/√2
  d[3] = {hn::Mul(half, hn::Sub(d3.im, d3.re)), hn::Neg(hn::Mul(half, hn::Add(d3.re, d3.im)))};
  butterfly_4(s[0], s[1], s[2], s[3]);
  butterfly_4(d[0], d[1], d[2], d[3]);
  for (int i = 0; i < 4; ++i) {
    x[2 * i] = s[i];
    x[2 * i + 1] = d[i];
  }
}

HWY_INLINE void butterfly(Complex (&x)[4]) {
  butterfly_4(x[0], x[1], x[2], x[3]);
}

HWY_INLINE void butterfly(Complex (&x)[8]) {
  Complex s[4];
  Complex d[4];
  for (int a = 0; a < 4; ++a) {
    s[a] = x[a] + x[a + 4];
    d[a] = x[a] - x[a + 4];
  }
  finish_butterfly_8(s, d, x);
}

// The first radix of the transform on real counts times complex factors (L real, L imaginary parts
// a block): multiplication and first additions in one.
HWY_INLINE void weighted_butterfly(const Real (&count)[8], const float* factors, Complex (&x)[8]) {
  Complex s[4];
  Complex d[4];
  for (int a = 0; a < 4; ++a) {
    const Complex near = load(factors + a * 2 * lanes);
    const Complex far = load(factors + (a + 4) * 2 * lanes);
    const Complex shaped = {hn::Mul(count[a + 4], far.re), hn::Mul(count[a + 4], far.im)};
    s[a] = {hn::MulAdd(count[a], near.re, shaped.re), hn::MulAdd(count[a], near.im, shaped.im)};
    d[a] = {hn::MulSub(count[a], near.re, shaped.re), hn::MulSub(count[a], near.im, shaped.im)};
  }
  finish_butterfly_8(s, d, x);
}

// The same for real factors (L a block). Output 8 − q is the conjugate of output q: only x[0] to
// x[4] are made.
HWY_INLINE void real_butterfly(const Real (&count)[8], const float* factors, Complex (&x)[8]) {
  const Floats floats;
  Real s[4];
  Real d[4];
  for (int a = 0; a < 4; ++a) {
    const Real near = hn::Load(floats, factors + a * lanes);
    const Real shaped = hn::Mul(count[a + 4], hn::Load(floats, factors + (a + 4) * lanes));
    s[a] = hn::MulAdd(count[a], near, shaped);
    d[a] = hn::MulSub(count[a], near, shaped);
  }
  const Real half = hn::Set(floats, 0.70710678F);
  const Real across = hn::Mul(half, hn::Sub(d[1], d[3]));
  const Real down = hn::Mul(half, hn::Add(d[1], d[3]));
  const Real even = hn::Add(s[0], s[2]);
  const Real odd = hn::Add(s[1], s[3]);
  x[0] = {hn::Add(even, odd), hn::Zero(floats)};
  x[1] = {hn::Add(d[0], across), hn::Neg(hn::Add(d[2], down))};
  x[2] = {hn::Sub(s[0], s[2]), hn::Sub(s[3], s[1])};
  x[3] = {hn::Sub(d[0], across), hn::Sub(d[2], down)};
  x[4] = {hn::Sub(even, odd), hn::Zero(floats)};
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace octascope::pipeline::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
