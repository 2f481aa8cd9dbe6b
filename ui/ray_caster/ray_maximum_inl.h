// The highest level along each ray, and all that flows along it. For one instruction set; see ray_kernels.h.
#if defined(OCTASCOPE_RAY_MAXIMUM_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_RAY_MAXIMUM_INL
#undef OCTASCOPE_RAY_MAXIMUM_INL
#else
#define OCTASCOPE_RAY_MAXIMUM_INL
#endif

#include <hwy/highway.h>

#include "ui/ray_caster/ray_colour_inl.h"
#include "ui/ray_caster/ray_kernels.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::ui::HWY_NAMESPACE {

// Advances active lanes until each is in a brick with a level above `highest`.
HWY_INLINE void leap_lower_bricks(const RayFrame& frame, const std::uint16_t* bricks, Rays& rays,
                                  Int highest) {
  const Int highest_level = hn::ShiftRight<level_shift>(highest);
  while (true) {
    const IntMask active = rays.active();
    const Int brick = brick_at(frame, bricks, rays.octant, rays.position, active);
    const Int distance = hn::And(brick, whole(0xFF));
    const Int level = hn::And(hn::ShiftRight<8>(brick), whole(0xFF));
    const IntMask lower = hn::And(
        active, hn::Or(hn::Gt(distance, hn::Zero(Ints{})), hn::Not(hn::Gt(level, highest_level))));
    if (hn::AllFalse(Ints{}, lower))
      return;
    const Int more = hn::Max(hn::Sub(distance, whole(1)), hn::Zero(Ints{}));
    rays.leap(hn::IfThenElseZero(lower, samples_to_leap(rays.axes, rays.position, more)));
  }
}

// The highest level along each ray, and where it was.
struct Highest {
  Int level;
  Int sample;
};

HWY_INLINE Highest find_highest(const RayFrame& frame, Rays rays) {
  Highest highest{hn::Zero(Ints{}), hn::Zero(Ints{})};
  while (true) {
    leap_lower_bricks(frame, frame.bricks, rays, highest.level);
    if (hn::AllFalse(Ints{}, rays.active()))
      return highest;
    for (int i = 0; i < samples_per_check; ++i) {
      const IntMask valid = rays.active();
      const Int level =
          hn::IfThenElseZero(valid, interpolate(fetch_cell(frame, rays.position, valid)));
      highest.sample = hn::IfThenElse(hn::Gt(level, highest.level), rays.next, highest.sample);
      highest.level = hn::Max(level, highest.level);
      rays.step();
    }
  }
}

// FlowTable's entry there; 0 where nothing is seen to flow, and in other lanes.
HWY_INLINE Int flow_entry(const RayFrame& frame, const Position& position, IntMask valid) {
  const IntMask flows = flows_at(frame, position, valid);
  if (hn::AllFalse(Ints{}, flows))
    return hn::Zero(Ints{});
  const Int flow = interpolate(fetch_flow(frame, position, flows));
  return hn::IfThenElseZero(flows, table_entry(frame.flow_opacity_and_weight, flow));
}

// All that flows along each ray: how opaque it is, and the last sample up to which half was not reached.
struct FlowAlong {
  Real opacity;
  Int sample;
};

HWY_INLINE FlowAlong gather_flow(const RayFrame& frame, Rays rays) {
  Real transparency = real(1);
  Int half = hn::Zero(Ints{});
  while (true) {
    leap_lower_bricks(frame, frame.flow_bricks, rays, hn::Zero(Ints{}));
    if (hn::AllFalse(Ints{}, rays.active()))
      return {hn::Sub(real(1), transparency), half};
    for (int i = 0; i < samples_per_check; ++i) {
      const Int entry = flow_entry(frame, rays.position, rays.active());
      const Real opacity = hn::Mul(upper_16_bits(entry), real(1.0F / 65535));
      const RealMask counts = hn::And(hn::Gt(opacity, real(0)), hn::Ge(transparency, real(0.5F)));
      half = hn::IfThenElse(hn::RebindMask(Ints{}, counts), rays.next, half);
      transparency = hn::NegMulAdd(transparency, opacity, transparency);
      rays.step();
    }
  }
}

// Tints by what flows along each ray; where that is most of it, or all, it lies there.
HWY_INLINE void tint_maximum(const RayFrame& frame, const Rays& rays, Light& light, Int& sample,
                             RealMask& seen) {
  const FlowAlong flow = gather_flow(frame, rays);
  light.red = mix_flow(light.red, flow_wall.red, flow_middle.red, flow.opacity);
  light.green = mix_flow(light.green, flow_wall.green, flow_middle.green, flow.opacity);
  light.blue = mix_flow(light.blue, flow_wall.blue, flow_middle.blue, flow.opacity);
  const RealMask flows = hn::Gt(flow.opacity, real(0));
  const RealMask mostly = hn::Or(hn::Gt(flow.opacity, real(0.5F)), hn::And(flows, hn::Not(seen)));
  sample = hn::IfThenElse(hn::RebindMask(Ints{}, mostly), flow.sample, sample);
  seen = hn::Or(seen, flows);
}

// As opaque as it is bright.
template <bool WithFlow> void draw_maximum(const RayFrame& frame, Tile tile) {
  for_each_packet(frame, tile, [&](int x, int y, Rays& rays) HWY_ATTR {
    const Highest highest = find_highest(frame, rays);
    const Int entry = table_entry(frame.opacity_and_red, highest.level);
    const Int others = table_entry(frame.green_and_blue, highest.level);
    RealMask seen = hn::Gt(upper_16_bits(entry), real(0));
    Light light = Light::none();
    light.red = hn::IfThenElseZero(seen, lower_16_bits(entry));
    light.green = hn::IfThenElseZero(seen, upper_16_bits(others));
    light.blue = hn::IfThenElseZero(seen, lower_16_bits(others));
    if (frame.by_depth) {
      const Real along_mm =
          hn::MulAdd(hn::ConvertTo(Floats{}, highest.sample), real(frame.step_mm), rays.first_mm);
      const Tint tint = tint_at(frame, hn::MulAdd(rays.direction.z, along_mm, real(frame.eye[0])));
      light.red = hn::Mul(light.red, tint.red);
      light.green = hn::Mul(light.green, tint.green);
      light.blue = hn::Mul(light.blue, tint.blue);
    }
    Int sample = highest.sample;
    if constexpr (WithFlow)
      tint_maximum(frame, rays, light, sample, seen);
    const Real opacity =
        hn::Mul(hn::Max(light.red, hn::Max(light.green, light.blue)), real(1.0F / 65535));
    const Real depth = hn::IfThenElse(seen, rays.depth_mm(frame, sample), real(no_depth));
    store(frame, x, y, to_rgba(light, opacity), depth);
  });
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace octascope::ui::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
