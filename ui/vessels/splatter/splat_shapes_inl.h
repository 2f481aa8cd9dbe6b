// Draws the rounded trapezoids of ui/vessels/scene/vessel_scene.h, by testing pixel centres. For
// one instruction set; see splat_kernels.h.
//
// Small ones are drawn side by side, one in each lane: along their major axis, each column has only
// a few candidate pixel centres, within √2 radii of the line through the ends. (A point of the
// shape is at most a radius off the line, or off one end and the line rises no faster than 45
// degrees.) Large ones are drawn one at a time, pixels of a row in the lanes.
#if defined(OCTASCOPE_SPLAT_SHAPES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_SPLAT_SHAPES_INL
#undef OCTASCOPE_SPLAT_SHAPES_INL
#else
#define OCTASCOPE_SPLAT_SHAPES_INL
#endif

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "ui/vessels/splatter/splat_relief_inl.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::ui::HWY_NAMESPACE {
namespace splat {

// 2^v for −126 < v < 126, to about 2e-7 of it.
HWY_INLINE Real exp2_of(Real v) {
  const Real nearest = hn::Round(v);
  const Real f = hn::Sub(v, nearest);
  Real sum = real(1.54035304e-4F);
  for (const float coefficient :
       {1.33335581e-3F, 9.61812911e-3F, 5.55041087e-2F, 2.40226507e-1F, 6.93147181e-1F, 1.0F})
    sum = hn::MulAdd(sum, f, real(coefficient));
  const Int exponent = hn::ShiftLeft<23>(hn::ConvertTo(Ints{}, nearest));
  return hn::BitCast(Floats{}, hn::Add(hn::BitCast(Ints{}, sum), exponent));
}

// One end of a segment on the screen.
struct End {
  float column;
  float line;
  float nearness;    // 1 / distance along the view
  float log2_radius; // in mm
};
static_assert(sizeof(End) == 16);

// A segment in each lane.
struct Shapes {
  Real ax, ay, dx, dy; // first end and the way to the second
  Real ra, dr;         // likewise, in pixels
  Real wa, dw;         // nearness
  Real widest;
  Real inverse_length2; // 0: both ends coincide
  Word colour;
};

class ShapeQueue {
public:
  explicit ShapeQueue(const SplatFrame& frame) : frame_{frame}, fragments_{frame} {}
  ShapeQueue(const ShapeQueue&) = delete;
  ShapeQueue& operator=(const ShapeQueue&) = delete;

  HWY_INLINE void add(const End& start, const End& end, BaseColour colour) {
    starts_[count_] = start;
    ends_[count_] = end;
    colours_[count_] = colour;
    ++count_;
  }
  // How many more add() calls are possible before draw_full().
  HWY_INLINE std::size_t space() const { return room - count_; }

  // Draws what fills whole registers and keeps the rest.
  void draw_full() {
    std::size_t i = 0;
    for (; i + lanes <= count_; i += lanes)
      draw(i, lanes);
    const std::size_t rest = count_ - i;
    std::copy_n(starts_ + i, rest, starts_);
    std::copy_n(ends_ + i, rest, ends_);
    std::copy_n(colours_ + i, rest, colours_);
    count_ = rest;
  }

  // Draws all, into the picture.
  void finish() {
    draw_full();
    if (count_ > 0) {
      std::fill(starts_ + count_, starts_ + lanes, starts_[0]);
      std::fill(ends_ + count_, ends_ + lanes, ends_[0]);
      std::fill(colours_ + count_, colours_ + lanes, colours_[0]);
      draw(0, count_);
      count_ = 0;
    }
    fragments_.flush();
  }

private:
  static constexpr std::size_t room = 320;
  static constexpr float most_columns = 24; // of those drawn side by side
  static constexpr float widest_small = 2;  // their radius

  Shapes load(std::size_t i) const {
    Shapes s;
    Real bx, by, wb, la, lb;
    hn::LoadInterleaved4(Floats{}, &starts_[i].column, s.ax, s.ay, s.wa, la);
    hn::LoadInterleaved4(Floats{}, &ends_[i].column, bx, by, wb, lb);
    s.colour = hn::LoadU(Words{}, colours_ + i);
    s.dx = hn::Sub(bx, s.ax);
    s.dy = hn::Sub(by, s.ay);
    s.dw = hn::Sub(wb, s.wa);
    const Real least =
        hn::IfThenElseZero(hn::RebindMask(Floats{}, hn::TestBit(s.colour, word(kept_visible))),
                           real(least_vessel_radius_px));
    const Real scale = real(frame_.pixels_per_unit);
    const Real rb = hn::Max(hn::Mul(exp2_of(lb), hn::Mul(scale, wb)), least);
    s.ra = hn::Max(hn::Mul(exp2_of(la), hn::Mul(scale, s.wa)), least);
    const Real length2 = hn::MulAdd(s.dx, s.dx, hn::Mul(s.dy, s.dy));
    s.widest = hn::Max(s.ra, rb);
    const Mask apart = hn::Gt(length2, real(0));
    s.ra = hn::IfThenElse(apart, s.ra, s.widest);
    s.dr = hn::IfThenElseZero(apart, hn::Sub(rb, s.ra));
    s.inverse_length2 =
        hn::IfThenElseZero(apart, hn::Div(real(1), hn::IfThenElse(apart, length2, real(1))));
    return s;
  }

  // The lanes of `candidates` that cover the centre of the pixel (qx, qy) from their first end.
  // shown(nearness) is the nearness of the visible surface where the axis has that one.
  template <class Shown>
  HWY_INLINE void cover(const Shapes& s, Real qx, Real qy, Int pixel, Mask candidates,
                        const Shown& shown) {
    const Real along = hn::Mul(hn::MulAdd(qx, s.dx, hn::Mul(qy, s.dy)), s.inverse_length2);
    const Real t = hn::Min(hn::Max(along, real(0)), real(1));
    const Real ex = hn::NegMulAdd(t, s.dx, qx);
    const Real ey = hn::NegMulAdd(t, s.dy, qy);
    const Real off2 = hn::MulAdd(ex, ex, hn::Mul(ey, ey));
    const Real r = hn::MulAdd(t, s.dr, s.ra);
    const Real r2 = hn::Mul(r, r);
    const Mask covered = hn::And(candidates, hn::Le(off2, r2));
    if (hn::AllFalse(Floats{}, covered))
      return;
    const Real nearness = hn::MulAdd(t, s.dw, s.wa);
    const Mask seen = hn::And(covered, hn::Ge(nearness, real(1 / frame_.far_mm)));
    fragments_.add(pixel, shown(nearness), hn::Div(off2, hn::Max(r2, real(1e-30F))), s.colour,
                   seen);
  }

  void draw(std::size_t i, std::size_t count) {
    const Shapes s = load(i);
    const Real wide = hn::Abs(s.dx);
    const Real high = hn::Abs(s.dy);
    const Mask used = hn::FirstN(Floats{}, count);
    const Mask small = hn::And(hn::Le(hn::Max(wide, high), real(most_columns)),
                               hn::Le(s.widest, real(widest_small)));
    draw_small(s, hn::And(used, small));
    const Mask large = hn::AndNot(small, used);
    if (HWY_UNLIKELY(!hn::AllFalse(Floats{}, large)))
      draw_large(s, large);
  }

  HWY_INLINE void draw_small(const Shapes& s, Mask drawn) {
    // u along the major axis, v across.
    const Mask steep = hn::Gt(hn::Abs(s.dy), hn::Abs(s.dx));
    const Real au = hn::IfThenElse(steep, s.ay, s.ax);
    const Real av = hn::IfThenElse(steep, s.ax, s.ay);
    const Real du = hn::IfThenElse(steep, s.dy, s.dx);
    const Real dv = hn::IfThenElse(steep, s.dx, s.dy);
    const Real w = real(static_cast<float>(frame_.width - 1));
    const Real h = real(static_cast<float>(frame_.height - 1));
    const Real last_u = hn::IfThenElse(steep, h, w);
    const Real last_v = hn::IfThenElse(steep, w, h);
    const Int stride_u =
        hn::IfThenElse(hn::RebindMask(Ints{}, steep), whole(frame_.width), whole(1));
    const Int stride_v =
        hn::IfThenElse(hn::RebindMask(Ints{}, steep), whole(1), whole(frame_.width));
    const Mask flat = hn::Eq(du, real(0));
    const Real slope =
        hn::IfThenElseZero(hn::Not(flat), hn::Div(dv, hn::IfThenElse(flat, real(1), du)));
    const Real reach = hn::MulAdd(s.widest, real(1.41422F), real(1e-4F));
    const Real margin = hn::Add(s.widest, real(1e-4F));
    const Real first = hn::Max(hn::Ceil(hn::Sub(hn::Min(au, hn::Add(au, du)), margin)), real(0));
    const Real last = hn::Min(hn::Floor(hn::Add(hn::Max(au, hn::Add(au, du)), margin)), last_u);
    Real u = first;
    Mask going = hn::And(drawn, hn::Le(u, last));
    while (!hn::AllFalse(Floats{}, going)) {
      const Real qu = hn::Sub(u, au);
      const Real centre = hn::MulAdd(slope, qu, av);
      Real v = hn::Max(hn::Ceil(hn::Sub(centre, reach)), real(0));
      const Real end = hn::Min(hn::Add(centre, reach), last_v);
      Mask candidates = hn::And(going, hn::Le(v, end));
      while (!hn::AllFalse(Floats{}, candidates)) {
        const Real qv = hn::Sub(v, av);
        const Int pixel = hn::Add(hn::Mul(hn::ConvertTo(Ints{}, u), stride_u),
                                  hn::Mul(hn::ConvertTo(Ints{}, v), stride_v));
        cover(s, hn::IfThenElse(steep, qv, qu), hn::IfThenElse(steep, qu, qv), pixel, candidates,
              [](Real nearness) { return nearness; });
        v = hn::Add(v, real(1));
        candidates = hn::And(candidates, hn::Le(v, end));
      }
      u = hn::Add(u, real(1));
      going = hn::And(going, hn::Le(u, last));
    }
  }

  HWY_NOINLINE void draw_large(const Shapes& all, Mask large) {
    // By lane: the members of Shapes, in order.
    HWY_ALIGN float values[10][lanes];
    HWY_ALIGN std::uint32_t colours[lanes];
    const Real fields[] = {all.ax, all.ay, all.dx, all.dy,     all.ra,
                           all.dr, all.wa, all.dw, all.widest, all.inverse_length2};
    for (std::size_t f = 0; f < std::size(fields); ++f)
      hn::Store(fields[f], Floats{}, values[f]);
    hn::Store(all.colour, Words{}, colours);
    HWY_ALIGN float chosen[lanes];
    hn::Store(hn::IfThenElseZero(large, real(1)), Floats{}, chosen);
    for (std::size_t i = 0; i < lanes; ++i)
      if (chosen[i] != 0)
        draw_rows({real(values[0][i]), real(values[1][i]), real(values[2][i]), real(values[3][i]),
                   real(values[4][i]), real(values[5][i]), real(values[6][i]), real(values[7][i]),
                   real(values[8][i]), real(values[9][i]), word(colours[i])});
  }

  // The same segment in all lanes.
  void draw_rows(const Shapes& s) {
    const auto one = [](Real v) { return hn::GetLane(v); };
    const float ax = one(s.ax), ay = one(s.ay), dx = one(s.dx), dy = one(s.dy);
    const float r = one(s.widest) * 1.0001F + 1e-3F;
    const bool in_relief = one(s.widest) >= least_relief_px;
    const Relief relief{frame_, {ax, ay, dx, dy, one(s.ra), one(s.dr), one(s.wa), one(s.dw)}};
    const float length = std::sqrt(dx * dx + dy * dy);
    const auto from = [](float v) { return static_cast<std::int32_t>(std::ceil(v)); };
    const auto within = [&](float v, int last) {
      return std::clamp(v, -1.0F, static_cast<float>(last) + 1);
    };
    const float lowest = within(std::min(ax, ax + dx) - r, frame_.width - 1);
    const float highest = within(std::max(ax, ax + dx) + r, frame_.width - 1);
    const std::int32_t top =
        std::max(from(within(std::min(ay, ay + dy) - r, frame_.height - 1)), 0);
    const std::int32_t bottom =
        std::min(from(within(std::max(ay, ay + dy) + r, frame_.height - 1)), frame_.height - 1);
    const Real steps = hn::ConvertTo(Floats{}, hn::Iota(Ints{}, 0));
    for (std::int32_t y = top; y <= bottom; ++y) {
      const float qy = static_cast<float>(y) - ay;
      float left = lowest;
      float right = highest;
      // Off the line through the ends by no more than r.
      if (std::abs(dy) > 1e-3F * length) {
        const float middle = ax + qy * dx / dy;
        const float half = std::abs(r * length / dy) + 1e-3F * std::abs(qy);
        left = std::clamp(middle - half, lowest, highest + 1);
        right = std::clamp(middle + half, lowest - 1, highest);
      }
      const std::int32_t end =
          std::min(static_cast<std::int32_t>(std::floor(right)) + 1, frame_.width);
      for (std::int32_t x = std::max(from(left), 0); x < end;
           x += static_cast<std::int32_t>(lanes)) {
        const Mask inside = hn::FirstN(Floats{}, static_cast<std::size_t>(end - x));
        const Int pixel = hn::Iota(Ints{}, y * frame_.width + x);
        const Real qx = hn::Add(steps, real(static_cast<float>(x) - ax));
        cover(s, qx, real(qy), pixel, inside, [&](Real nearness) {
          return in_relief ? relief.nearness(qx, real(qy), nearness) : nearness;
        });
      }
    }
  }

  const SplatFrame& frame_;
  Fragments fragments_;
  std::size_t count_ = 0;
  HWY_ALIGN End starts_[room + lanes];
  HWY_ALIGN End ends_[room + lanes];
  HWY_ALIGN BaseColour colours_[room + lanes];
};

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace splat
} // namespace octascope::ui::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
