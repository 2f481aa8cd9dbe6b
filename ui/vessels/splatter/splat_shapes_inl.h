// Draws the rounded trapezoids of ui/vessels/scene/vessel_scene.h, pixel centre by pixel centre.
// For one instruction set; see splat_kernels.h.
//
// Small ones are drawn in parallel, one per lane: each column along the segment's major axis has
// only a few candidate pixel centres, since a point of the shape is at most a radius off the line
// through the ends. Large ones are drawn one at a time, with the pixels of a row in the lanes.
#if defined(OCTASCOPE_SPLAT_SHAPES_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_SPLAT_SHAPES_INL
#undef OCTASCOPE_SPLAT_SHAPES_INL
#else
#define OCTASCOPE_SPLAT_SHAPES_INL
#endif

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "ui/vessels/splatter/splat_relief_inl.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::ui::HWY_NAMESPACE {
namespace splat {

// 2^v for −126 < v < 126, with a relative error of about 2e-7.
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

// One segment per lane.
struct Shapes {
  Real ax, ay, dx, dy; // first end and the difference to the second
  Real ra, dr;         // likewise, in pixels
  Real wa, dw;         // nearness
  Real widest;
  Real inverse_length2; // 0: both ends coincide
  Word colour;
  // SegmentCourse, in its body and in its round ends; of those that rise (vessel_scene.h).
  Word body;
  Word ends;
};

class ShapeQueue {
public:
  ShapeQueue(const SplatFrame& frame, Fragments& fragments)
      : frame_{frame}, fragments_{fragments} {}
  ShapeQueue(const ShapeQueue&) = delete;
  ShapeQueue& operator=(const ShapeQueue&) = delete;

  HWY_INLINE void add(const End& start, const End& end, BaseColour colour) {
    starts_[count_] = start;
    ends_[count_] = end;
    colours_[count_] = colour;
    ++count_;
  }
  // How often add() may be called before draw_full() is needed.
  HWY_INLINE std::size_t space() const { return room - count_; }

  // Draws the segments that fill whole registers and keeps the others. `dots`: none of them may
  // cover more than one pixel centre.
  void draw_full(bool dots) {
    std::size_t i = 0;
    for (; i + lanes <= count_; i += lanes)
      draw(i, lanes, dots);
    const std::size_t rest = count_ - i;
    std::copy_n(starts_ + i, rest, starts_);
    std::copy_n(ends_ + i, rest, ends_);
    std::copy_n(colours_ + i, rest, colours_);
    count_ = rest;
  }

  // Draws all remaining segments.
  void finish(bool dots) {
    draw_full(dots);
    if (count_ > 0) {
      std::fill(starts_ + count_, starts_ + lanes, starts_[0]);
      std::fill(ends_ + count_, ends_ + lanes, ends_[0]);
      std::fill(colours_ + count_, colours_ + lanes, colours_[0]);
      draw(0, count_, dots);
      count_ = 0;
    }
  }

private:
  static constexpr std::size_t room = 320;
  static constexpr float most_columns = 24;   // of those drawn in parallel
  static constexpr float widest_small = 2;    // their largest radius
  static constexpr float least_asked_px = 16; // from this radius on, hidden pixels are looked for

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

  // The lanes among `candidates` that cover the centre of the pixel at (qx, qy) from their first
  // end. surface(where, nearness, height2, along) is what is raised further by the course: of the
  // axis's nearness and the squared height of the round side above it. It may move the place;
  // along: 0 to 1 in the body, else in a round end.
  template <class Surface>
  HWY_INLINE void cover(const Shapes& s, Real qx, Real qy, Int pixel, Mask candidates,
                        const Surface& surface) {
    const Real along = hn::Mul(hn::MulAdd(qx, s.dx, hn::Mul(qy, s.dy)), s.inverse_length2);
    const Real t = hn::Min(hn::Max(along, real(0)), real(1));
    const Real ex = hn::NegMulAdd(t, s.dx, qx);
    const Real ey = hn::NegMulAdd(t, s.dy, qy);
    const Real off2 = hn::MulAdd(ex, ex, hn::Mul(ey, ey));
    const Real r = hn::MulAdd(t, s.dr, s.ra);
    const Real nearness = hn::MulAdd(t, s.dw, s.wa);
    const Mask covered = hn::And(hn::And(candidates, hn::Le(off2, hn::Mul(r, r))),
                                 hn::Ge(nearness, real(1 / frame_.far_mm)));
    if (hn::AllFalse(Floats{}, covered))
      return;
    const Mask wide = hn::Ge(r, real(least_raised_px));
    const Mask thin_covered = hn::AndNot(wide, covered);
    if (!hn::AllFalse(Floats{}, thin_covered))
      fragments_.add_thin(pixel, nearness, s.colour, thin_covered);
    const Mask wide_covered = hn::And(wide, covered);
    if (hn::AllFalse(Floats{}, wide_covered))
      return;
    const Word course = hn::IfThenElse(hn::RebindMask(Words{}, in_body(along)), s.body, s.ends);
    WithinVessel where{ex, ey, r, course};
    const Real raised = surface(where, nearness, hn::MulSub(r, r, off2), along);
    fragments_.add_wide(pixel, raised, s.colour, where, wide_covered);
  }

  static HWY_INLINE Mask in_body(Real along) {
    return hn::And(hn::Ge(along, real(0)), hn::Le(along, real(1)));
  }

  // 1 + slope², see vessel_scene.h.
  HWY_INLINE Real stretch_of(const Shapes& s) const {
    const Real length = hn::Sqrt(hn::MulAdd(s.dx, s.dx, hn::Mul(s.dy, s.dy)));
    const Real slope = hn::Min(hn::Div(hn::Mul(hn::Abs(s.dw), real(frame_.pixels_per_unit)),
                                       hn::Max(hn::Mul(s.wa, length), real(1e-9F))),
                               real(steepest_rise));
    return hn::MulAdd(slope, slope, real(1));
  }

  // `rises`: 0 where its surface is found otherwise.
  HWY_INLINE void find_course(Shapes& s, Real stretch, float rises) const {
    const auto bits = [](Real share, std::uint32_t all) {
      const Real exact = hn::MulAdd(share, real(static_cast<float>(all)), real(0.5F));
      return hn::BitCast(Words{}, hn::ConvertTo(Ints{}, exact));
    };
    const auto flag = [](Mask mask, std::uint32_t bit) {
      return hn::IfThenElseZero(hn::RebindMask(Words{}, mask), word(bit));
    };
    const Real wide = hn::Abs(s.dx);
    const Real high = hn::Abs(s.dy);
    const Real major = hn::Max(wide, high);
    const Real tilt = hn::Div(hn::Min(wide, high), hn::Max(major, real(1e-9F)));
    const Word way = hn::Or(hn::ShiftLeft<course_rise_bits>(bits(tilt, whole_slope)),
                            flag(hn::Ge(high, wide), course_across));
    const float rise = rises / most_rise;
    s.ends = hn::Or(way, bits(real(rise), whole_rise));
    // Seen from its end it has no way.
    s.body = hn::Or(hn::Or(way, flag(hn::Gt(major, real(0)), course_body)),
                    bits(hn::Mul(hn::Sqrt(stretch), real(rise)), whole_rise));
  }

  void draw(std::size_t i, std::size_t count, bool dots) {
    Shapes s = load(i);
    const Mask used = hn::FirstN(Floats{}, count);
    if (!hn::AllFalse(Floats{}, hn::Ge(s.widest, real(least_raised_px))))
      find_course(s, stretch_of(s), 1);
    if (dots) {
      draw_dots(s, used);
      return;
    }
    const Mask small = hn::And(hn::Le(hn::Max(hn::Abs(s.dx), hn::Abs(s.dy)), real(most_columns)),
                               hn::Le(s.widest, real(widest_small)));
    draw_small(s, hn::And(used, small));
    const Mask large = hn::AndNot(small, used);
    if (HWY_UNLIKELY(!hn::AllFalse(Floats{}, large)))
      draw_large(s, large);
  }

  // As much nearer as `rise` pixels are wide there.
  HWY_INLINE Real raised(Real nearness, Real rise) const {
    return hn::MulAdd(nearness, hn::Mul(rise, real(1 / frame_.pixels_per_unit)), nearness);
  }

  // The last centre of its rectangle is the only one.
  HWY_INLINE void draw_dots(const Shapes& s, Mask drawn) {
    const Real reach = hn::Add(s.widest, real(1e-4F));
    const Real x = hn::Floor(hn::Add(hn::Max(s.ax, hn::Add(s.ax, s.dx)), reach));
    const Real y = hn::Floor(hn::Add(hn::Max(s.ay, hn::Add(s.ay, s.dy)), reach));
    const auto within = [](Real v, int size) {
      return hn::And(hn::Ge(v, real(0)), hn::Lt(v, real(static_cast<float>(size))));
    };
    const Mask seen = hn::And(within(x, frame_.width), within(y, frame_.height));
    const Int pixel =
        hn::Add(hn::Mul(hn::ConvertTo(Ints{}, y), whole(frame_.width)), hn::ConvertTo(Ints{}, x));
    cover(s, hn::Sub(x, s.ax), hn::Sub(y, s.ay), pixel, hn::And(drawn, seen),
          [](WithinVessel&, Real nearness, Real, Real) { return nearness; });
  }

  HWY_INLINE void draw_small(const Shapes& s, Mask drawn) {
    // u runs along the segment's major axis, v across.
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
    const Real per_v = hn::Sqrt(hn::MulAdd(slope, slope, real(1.00001F)));
    const Real reach = hn::MulAdd(s.widest, per_v, real(1e-4F));
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
              [](WithinVessel&, Real nearness, Real, Real) { return nearness; });
        v = hn::Add(v, real(1));
        candidates = hn::And(candidates, hn::Le(v, end));
      }
      u = hn::Add(u, real(1));
      going = hn::And(going, hn::Le(u, last));
    }
  }

  HWY_NOINLINE void draw_large(const Shapes& all, Mask large) {
    // Per lane: the members of Shapes one after the other.
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
                   real(values[8][i]), real(values[9][i]), word(colours[i]), word(0), word(0)});
  }

  // Expects the same segment in all lanes.
  void draw_rows(Shapes s) {
    const auto one = [](Real v) { return hn::GetLane(v); };
    const float ax = one(s.ax), ay = one(s.ay), dx = one(s.dx), dy = one(s.dy);
    const float r = one(s.widest) * 1.0001F + 1e-3F;
    const bool in_relief = one(s.widest) >= least_relief_px;
    const Real stretch = stretch_of(s);
    find_course(s, stretch, in_relief ? 0 : 1);
    const Relief relief{frame_, {ax, ay, dx, dy, one(s.ra), one(s.dr), one(s.wa), one(s.dw)}};
    const bool has_many_pixels = one(s.widest) >= least_asked_px;
    const float nearest_mm = nearest_of(s);
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
      // Within r of the line through the ends.
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
        Mask inside = hn::FirstN(Floats{}, static_cast<std::size_t>(end - x));
        if (has_many_pixels) { // those that are hidden cost more than to ask
          inside =
              hn::And(inside, hn::Ge(shown_at(y * frame_.width + x, end - x), real(nearest_mm)));
          if (hn::AllFalse(Floats{}, inside))
            continue;
        }
        const Int pixel = hn::Iota(Ints{}, y * frame_.width + x);
        const Real qx = hn::Add(steps, real(static_cast<float>(x) - ax));
        const auto surface = [&](WithinVessel& where, Real nearness, Real height2, Real along) {
          if (!in_relief)
            return nearness;
          const Mask body = in_body(along);
          const auto [seen, on_sides] = relief.surface(qx, real(qy), nearness);
          const Real most = hn::IfThenElse(body, hn::Mul(height2, stretch), height2);
          const Real rise = hn::Sqrt(hn::Max(most, real(0)));
          const Real nearest = hn::Max(seen, raised(nearness, hn::Mul(rise, real(relief_rise))));
          if (hn::AllTrue(Floats{}, body))
            return nearest;
          const Mask prolonged = hn::AndNot(body, on_sides);
          where.ex = hn::IfThenElse(prolonged, hn::NegMulAdd(along, s.dx, qx), where.ex);
          where.ey = hn::IfThenElse(prolonged, hn::NegMulAdd(along, s.dy, real(qy)), where.ey);
          where.course = hn::IfThenElse(hn::RebindMask(Words{}, prolonged), s.body, where.course);
          const Mask ball = hn::Not(hn::Or(body, on_sides));
          const Mask at_far_end = hn::And(ball, hn::Lt(hn::Mul(along, s.dw), real(0)));
          light_far_end(where, height2, stretch, at_far_end);
          const Real set_back = hn::IfThenElse(at_far_end, real(2 * end_set_back),
                                               hn::IfThenElseZero(ball, real(end_set_back)));
          return hn::NegMulAdd(nearest, set_back, nearest);
        };
        cover(s, qx, real(qy), pixel, inside, surface);
      }
    }
  }

  // Moves the place, as far within the outline as it was, to where the light is that of a round side
  // so much higher (its square).
  static HWY_INLINE void light_far_end(WithinVessel& where, Real height2, Real stretch,
                                       Mask moved) {
    const Real r2 = hn::Mul(where.r, where.r);
    const Real off = hn::Sqrt(hn::Max(hn::Sub(r2, height2), real(1e-6F)));
    const Real lit = hn::Min(hn::Div(hn::Mul(height2, stretch), r2), real(1));
    const Real share = hn::Sqrt(hn::Sub(real(1), lit)); // of the radius
    // No thinner than what is wholly shaded (least_shaded_px).
    const Real r = hn::Max(hn::Div(hn::Max(hn::Sub(where.r, off), real(0)),
                                   hn::Max(hn::Sub(real(1), share), real(1e-6F))),
                           hn::Min(where.r, real(least_shaded_px + 1)));
    const Real scale = hn::Div(hn::Mul(share, r), off);
    where.ex = hn::IfThenElse(moved, hn::Mul(where.ex, scale), where.ex);
    where.ey = hn::IfThenElse(moved, hn::Mul(where.ey, scale), where.ey);
    where.r = hn::IfThenElse(moved, r, where.r);
  }

  // No part of the segment is nearer.
  float nearest_of(const Shapes& s) const {
    const float a_mm = 1 / hn::GetLane(s.wa);
    const float b_mm = 1 / hn::GetLane(hn::Add(s.wa, s.dw));
    const float rise = std::sqrt(1 + steepest_rise * steepest_rise) * hn::GetLane(s.widest);
    return std::min(a_mm, b_mm) - 1.01F * rise * std::max(a_mm, b_mm) / frame_.pixels_per_unit;
  }

  // The distances that the picture shows so far, from that pixel on, of at most so many.
  HWY_INLINE Real shown_at(std::int32_t pixel, std::int32_t count) const {
    HWY_ALIGN std::uint32_t distances[lanes] = {};
    const auto most = std::min(static_cast<std::int32_t>(lanes), count);
    for (std::int32_t i = 0; i < most; ++i)
      distances[i] = static_cast<std::uint32_t>(
          std::atomic_ref<DepthPixel>{frame_.pixels[pixel + i]}.load(std::memory_order_relaxed) >>
          32U);
    return hn::BitCast(Floats{}, hn::Load(Words{}, distances));
  }

  const SplatFrame& frame_;
  Fragments& fragments_;
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
