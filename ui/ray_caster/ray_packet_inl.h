// A packet of rays: a rectangle of neighbouring pixels in the lanes of a register. For one
// instruction set; see ray_kernels.h.
#if defined(OCTASCOPE_RAY_PACKET_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_RAY_PACKET_INL
#undef OCTASCOPE_RAY_PACKET_INL
#else
#define OCTASCOPE_RAY_PACKET_INL
#endif

#include <algorithm>
#include <bit>
#include <cstddef>

#include <hwy/highway.h>

#include "ui/dither/dither_mask.h"
#include "ui/ray_caster/ray_sampling_inl.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::ui::HWY_NAMESPACE {

inline constexpr int packet_width = lanes >= 8 ? 4 : 2;
inline constexpr int packet_height = lanes / packet_width;

inline constexpr int samples_per_check = 4; // between two checks for empty bricks
inline constexpr int samples_of_haze =
    8; // likewise, for one that stands for all (coarse_beside_flow)

// The samples of each ray are numbered from 0, at t = first_mm.
struct Rays {
  Position position; // of sample `next`
  BrickAxes axes;
  Int octant;           // offset of its bricks
  RealVector direction; // cells per mm
  Real first_mm;
  Real cosine; // between ray and view
  Int next;
  Int end;    // one past the last sample
  Int chosen; // of so many samples taken together, the one that stands for all (coarse_beside_flow)

  HWY_INLINE IntMask active() const { return hn::Lt(next, end); }
  HWY_INLINE void step() {
    position.z = hn::Add(position.z, axes.z.step);
    position.a = hn::Add(position.a, axes.a.step);
    position.b = hn::Add(position.b, axes.b.step);
    next = hn::Add(next, whole(1));
  }
  HWY_INLINE void leap(Int samples) {
    position.z = hn::Add(position.z, hn::Mul(axes.z.step, samples));
    position.a = hn::Add(position.a, hn::Mul(axes.a.step, samples));
    position.b = hn::Add(position.b, hn::Mul(axes.b.step, samples));
    next = hn::Add(next, samples);
  }
  HWY_INLINE Real depth_mm(const RayFrame& frame, Int sample) const {
    const Real t = hn::MulAdd(hn::ConvertTo(Floats{}, sample), real(frame.step_mm), first_mm);
    return hn::Mul(t, cosine);
  }
};

struct Interval {
  Real from, to;
};

HWY_INLINE void clip(Interval& interval, float lower, float upper, float eye, Real direction) {
  const Real safe =
      hn::IfThenElse(hn::Lt(hn::Abs(direction), real(1e-12F)), real(1e-12F), direction);
  const Real at_lower = hn::Div(real(lower - eye), safe);
  const Real at_upper = hn::Div(real(upper - eye), safe);
  interval.from = hn::Max(interval.from, hn::Min(at_lower, at_upper));
  interval.to = hn::Min(interval.to, hn::Max(at_lower, at_upper));
}

// Where rays leave what a cut takes away, in which they begin (ui/view/cut.h).
HWY_INLINE Real end_of_cut(const RayFrame& frame, const RealVector& direction) {
  const Real never = real(1e9F);
  const auto reaches = [&](float face, float eye, Real along) {
    const Real safe = hn::IfThenElse(hn::Lt(hn::Abs(along), real(1e-12F)), real(1e-12F), along);
    const Real at = hn::Div(real(face - eye), safe);
    return hn::IfThenElse(hn::Ge(at, real(0)), at, never);
  };
  return hn::Min(reaches(frame.cut[0], frame.eye[1], direction.a),
                 reaches(frame.cut[1], frame.eye[2], direction.b));
}

HWY_INLINE Real dither(const RayFrame& frame, Int x, Int y_from_bottom) {
  const Int last = whole(dither_size - 1);
  const Int row = hn::Mul(hn::And(y_from_bottom, last), whole(dither_size));
  return hn::GatherIndex(Floats{}, frame.dither, hn::Add(row, hn::And(x, last)));
}

// The stops' distances along the view; x and y are the packet's first pixel. Pixels beyond the
// picture's border take the value at the border.
HWY_INLINE Real stops_of(const RayFrame& frame, int x, int y) {
  alignas(64) float distances[lanes];
  for (int i = 0; i < lanes; ++i) {
    const int row = std::min(y + i / packet_width, frame.height - 1);
    const int column = std::min(x + i % packet_width, frame.width - 1);
    const std::uint64_t stop =
        frame.stops[static_cast<std::size_t>(row) * static_cast<std::size_t>(frame.width) +
                    static_cast<std::size_t>(column)];
    distances[i] = std::bit_cast<float>(static_cast<std::uint32_t>(stop >> 32U));
  }
  return hn::Load(Floats{}, distances);
}

HWY_INLINE Rays make_rays(const RayFrame& frame, int x, int y) {
  alignas(64) static constexpr std::int32_t column[16] = {0, 1, 2, 3, 0, 1, 2, 3,
                                                          0, 1, 2, 3, 0, 1, 2, 3};
  alignas(64) static constexpr std::int32_t row[16] = {0, 0, 0, 0, 1, 1, 1, 1,
                                                       2, 2, 2, 2, 3, 3, 3, 3};
  alignas(64) static constexpr std::int32_t small_column[4] = {0, 1, 0, 1};
  alignas(64) static constexpr std::int32_t small_row[4] = {0, 0, 1, 1};
  const Int dx = hn::Load(Ints{}, lanes >= 8 ? column : small_column);
  const Int dy = hn::Load(Ints{}, lanes >= 8 ? row : small_row);
  const Int column_at = hn::Add(whole(x), dx);
  const Int row_at = hn::Add(whole(y), dy);
  const Real px = hn::Add(hn::ConvertTo(Floats{}, column_at), real(0.5F));
  const Real py = hn::Add(hn::ConvertTo(Floats{}, row_at), real(0.5F));
  const auto half = [](int length) { return 0.5F * static_cast<float>(length); };
  const Real right = hn::MulAdd(hn::Sub(px, real(half(frame.width))), real(frame.pixel_width),
                                real(frame.centre_shift));
  const Real up = hn::Mul(hn::Sub(real(half(frame.height)), py), real(frame.pixel_height));

  Rays rays;
  const Real length = hn::Sqrt(hn::MulAdd(right, right, hn::MulAdd(up, up, real(1))));
  rays.cosine = hn::Div(real(1), length);
  const auto cells_per_mm = [&](int axis) {
    const Real sum = hn::MulAdd(right, real(frame.right[axis]),
                                hn::MulAdd(up, real(frame.up[axis]), real(frame.forward[axis])));
    return hn::Mul(sum, rays.cosine);
  };
  const RealVector d{cells_per_mm(0), cells_per_mm(1), cells_per_mm(2)};
  rays.direction = d;

  Interval inside{hn::Mul(real(frame.near_mm), length), real(1e9F)};
  clip(inside, frame.lower[0], frame.upper[0], frame.eye[0], d.z);
  clip(inside, frame.lower[1], frame.upper[1], frame.eye[1], d.a);
  clip(inside, frame.lower[2], frame.upper[2], frame.eye[2], d.b);

  if (frame.is_cut)
    inside.from = hn::Max(inside.from, end_of_cut(frame, d));
  if (frame.stops != nullptr)
    inside.to = hn::Min(inside.to, hn::Mul(stops_of(frame, x, y), length));

  // All rays' samples lie on common shells around the eye, shifted by each pixel's dither.
  const Real shift = dither(frame, column_at, hn::Sub(whole(frame.height - 1), row_at));
  const Int elsewhere = hn::Add(column_at, whole(dither_size / 2));
  rays.chosen = hn::ConvertTo(
      Ints{}, hn::Mul(real(samples_of_haze),
                      dither(frame, elsewhere, hn::Sub(whole(frame.height - 1), row_at))));
  const Real step = real(frame.step_mm);
  const Real per_step = real(1 / frame.step_mm);
  const Real shell = hn::Ceil(hn::Sub(hn::Mul(inside.from, per_step), shift));
  rays.first_mm = hn::Mul(hn::Add(shell, shift), step);
  const Real count = hn::Ceil(hn::Mul(hn::Sub(inside.to, rays.first_mm), per_step));
  rays.end = hn::ConvertTo(Ints{}, hn::Min(hn::Max(count, real(0)), real(1 << 20)));
  rays.next = hn::Zero(Ints{});

  const auto fixed = [](Real v) { return hn::NearestInt(hn::Mul(v, real(one_cell))); };
  const auto start = [&](int axis, Real direction) {
    return fixed(hn::MulAdd(direction, rays.first_mm, real(frame.eye[axis])));
  };
  rays.position = {start(0, d.z), start(1, d.a), start(2, d.b)};
  rays.axes = {make_brick_axis(fixed(hn::Mul(d.z, step))),
               make_brick_axis(fixed(hn::Mul(d.a, step))),
               make_brick_axis(fixed(hn::Mul(d.b, step)))};
  rays.octant = hn::Add(hn::And(rays.axes.z.towards, whole(frame.brick_octant)),
                        hn::Add(hn::And(rays.axes.a.towards, whole(2 * frame.brick_octant)),
                                hn::And(rays.axes.b.towards, whole(4 * frame.brick_octant))));
  return rays;
}

// Stores a packet, clipped to the picture; x and y are its first pixel.
HWY_INLINE void store(const RayFrame& frame, int x, int y, Int rgba, Real depth_mm) {
  alignas(64) std::int32_t colours[lanes];
  alignas(64) float depths[lanes];
  hn::Store(rgba, Ints{}, colours);
  hn::Store(depth_mm, Floats{}, depths);
  const int columns = std::min(packet_width, frame.width - x);
  const int rows = std::min(packet_height, frame.height - y);
  for (int row = 0; row < rows; ++row) {
    const std::size_t at =
        static_cast<std::size_t>(y + row) * static_cast<std::size_t>(frame.width) +
        static_cast<std::size_t>(x);
    for (int column = 0; column < columns; ++column) {
      const std::size_t to = at + static_cast<std::size_t>(column);
      frame.rgba[to] = static_cast<std::uint32_t>(colours[row * packet_width + column]);
      frame.depth_mm[to] = depths[row * packet_width + column];
    }
  }
}

template <class DrawPacket>
HWY_INLINE void for_each_packet(const RayFrame& frame, Tile tile, DrawPacket draw_packet) {
  const int right = std::min(tile.x + tile_size, frame.width);
  const int bottom = std::min(tile.y + tile_size, frame.height);
  for (int y = tile.y; y < bottom; y += packet_height)
    for (int x = tile.x; x < right; x += packet_width) {
      Rays rays = make_rays(frame, x, y);
      if (hn::AllFalse(Ints{}, rays.active()))
        store(frame, x, y, hn::Zero(Ints{}), real(no_depth));
      else
        draw_packet(x, y, rays);
    }
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace octascope::ui::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
