// Intersects rays with the round cone of a wide segment, as ui/shaders/vessels/vessel_relief.glsl does; the
// pixels of a row are in the lanes. For one instruction set; see splat_kernels.h.
#if defined(OCTASCOPE_SPLAT_RELIEF_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_SPLAT_RELIEF_INL
#undef OCTASCOPE_SPLAT_RELIEF_INL
#else
#define OCTASCOPE_SPLAT_RELIEF_INL
#endif

#include "ui/vessels/splatter/splat_fragments_inl.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::ui::HWY_NAMESPACE {
namespace splat {

// One segment: pixel and nearness of its first end, and the differences to the second; radii in
// pixels.
struct WideSegment {
  float ax, ay, dx, dy;
  float ra, dr;
  float wa, dw;
};

class Relief {
public:
  Relief(const SplatFrame& frame, const WideSegment& s)
      : near_{frame.near_mm}, per_px_{1 / frame.pixels_per_unit}, first_x_{s.ax -
                                                                           frame.middle_column},
        first_y_{s.ay - frame.middle_line}, za_{1 / s.wa}, ra_{s.ra * za_ * per_px_} {
    const float zb = 1 / (s.wa + s.dw);
    ex_ = ((first_x_ + s.dx) * zb - first_x_ * za_) * per_px_;
    ey_ = ((first_y_ + s.dy) * zb - first_y_ * za_) * per_px_;
    ez_ = zb - za_;
    growth_ = (s.ra + s.dr) * zb * per_px_ - ra_;
    k_ = ex_ * ex_ + ey_ * ey_ + ez_ * ez_ - growth_ * growth_;
  }

  struct Surface {
    Real nearness; // 1 / distance along the view; the axis's if the ray misses the cone
    Mask on_sides; // not on a ball at an end
  };
  // At the pixel (qx, qy) from the first end, where the axis has `axis_nearness`.
  HWY_INLINE Surface surface(Real qx, Real qy, Real axis_nearness) const {
    const Real z = hn::Div(real(1), axis_nearness);
    const Real px = hn::Add(qx, real(first_x_));
    const Real py = hn::Add(qy, real(first_y_));
    // The ray per mm along the view; the first end relative to the axis's point.
    const Vector ray{hn::Mul(px, real(per_px_)), hn::Mul(py, real(per_px_)), real(1)};
    const Vector a{hn::Mul(hn::NegMulAdd(px, z, real(first_x_ * za_)), real(per_px_)),
                   hn::Mul(hn::NegMulAdd(py, z, real(first_y_ * za_)), real(per_px_)),
                   hn::Sub(real(za_), z)};
    const Real ends = enter_ends(ray, a);
    const Real sides = k_ > 0 ? enter_sides(ray, a) : real(0);
    const Real change = hn::Min(ends, sides);
    const Real cut = hn::MulAdd(real(cut_relief), hn::Sub(z, real(near_)), real(near_));
    return {hn::Div(real(1), hn::Max(hn::Add(z, change), cut)), hn::Lt(sides, ends)};
  }

private:
  struct Vector {
    Real x, y, z;
  };

  static HWY_INLINE Real dot(const Vector& a, const Vector& b) {
    return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z)));
  }
  static HWY_INLINE Real root(Real v) { return hn::Sqrt(hn::Max(v, real(0))); }

  // The point at that share of the way to the second end.
  HWY_INLINE Vector place(const Vector& a, Real share) const {
    return {hn::MulAdd(share, real(ex_), a.x), hn::MulAdd(share, real(ey_), a.y),
            hn::MulAdd(share, real(ez_), a.z)};
  }

  // 0 if the ray misses it.
  HWY_INLINE Real enter_ball(const Vector& ray, const Vector& a, Real share) const {
    const Vector middle = place(a, share);
    const Real radius = hn::MulAdd(share, real(growth_), real(ra_));
    const Real along = dot(ray, middle);
    const Real square = dot(ray, ray);
    const Real rest = hn::NegMulAdd(square, hn::NegMulAdd(radius, radius, dot(middle, middle)),
                                    hn::Mul(along, along));
    return hn::IfThenElseZero(hn::Ge(rest, real(0)), hn::Div(hn::Sub(along, root(rest)), square));
  }

  HWY_INLINE Real enter_ends(const Vector& ray, const Vector& a) const {
    return hn::Min(enter_ball(ray, a, real(0)), enter_ball(ray, a, real(1)));
  }

  // 0 if the ray misses them.
  HWY_INLINE Real enter_sides(const Vector& ray, const Vector& a) const {
    const Vector e{real(ex_), real(ey_), real(ez_)};
    const Real per_k = real(1 / k_);
    const Real along = dot(ray, e);
    const Real m = hn::Sub(real(growth_ * ra_), dot(a, e));
    const Real square = hn::NegMulAdd(hn::Mul(along, along), per_k, dot(ray, ray));
    const Real half_linear = hn::Neg(hn::MulAdd(hn::Mul(along, m), per_k, dot(ray, a)));
    const Real constant = hn::NegMulAdd(hn::Mul(m, m), per_k, hn::Sub(dot(a, a), real(ra_ * ra_)));
    const Real rest = hn::NegMulAdd(square, constant, hn::Mul(half_linear, half_linear));
    const Mask meets =
        hn::And(hn::Ge(rest, real(0)), hn::Ge(hn::Abs(square), real(1e-9F))); // else parallel
    const Real divisor = hn::IfThenElse(meets, square, real(1));
    const auto met = [&](Real s) {
      const Real u = hn::Mul(hn::MulAdd(s, along, m), per_k);
      return hn::IfThenElseZero(hn::And(meets, hn::And(hn::Ge(u, real(0)), hn::Le(u, real(1)))), s);
    };
    const Real half = root(rest);
    return hn::Min(met(hn::Div(hn::Sub(hn::Neg(half_linear), half), divisor)),
                   met(hn::Div(hn::Sub(half, half_linear), divisor)));
  }

  float near_;
  float per_px_;            // mm per pixel at 1 mm along the view
  float first_x_, first_y_; // relative to the pixel straight ahead
  float za_;
  float ra_; // in mm, like the following
  float ex_ = 0, ey_ = 0, ez_ = 0;
  float growth_ = 0;
  float k_ = 0;
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace splat
} // namespace octascope::ui::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
