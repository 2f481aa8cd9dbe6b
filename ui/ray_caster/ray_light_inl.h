// The light of "shaded", once for each ray, where most of what it shows lies. For one instruction
// set; see ray_kernels.h.
#if defined(OCTASCOPE_RAY_LIGHT_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_RAY_LIGHT_INL
#undef OCTASCOPE_RAY_LIGHT_INL
#else
#define OCTASCOPE_RAY_LIGHT_INL
#endif

#include <hwy/highway.h>

#include "ui/ray_caster/light_volume.h"
#include "ui/ray_caster/ray_packet_inl.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::ui::HWY_NAMESPACE {

// A texel of LightVolume between its neighbours; slopes −1…1, density 0…1.
struct LightTexel {
  Real z, a, b, density;
};

// One axis of the texels beside a place.
struct TexelAxis {
  Int below, above; // as offsets
  Real to_above;
};

HWY_INLINE TexelAxis texel_axis(const RayFrame& frame, int axis, Real cells) {
  const RayFrame::LightAxis& light = frame.light_axes[axis];
  const Real last = real(static_cast<float>(light.count - 1));
  const Real at =
      hn::Min(hn::Max(hn::MulAdd(cells, real(light.scale), real(light.offset)), real(0)), last);
  const Int below = hn::ConvertTo(Ints{}, at);
  const Int above = hn::Min(hn::Add(below, whole(1)), whole(light.count - 1));
  return {hn::Mul(below, whole(light.stride)), hn::Mul(above, whole(light.stride)),
          hn::Sub(at, hn::ConvertTo(Floats{}, below))};
}

HWY_INLINE LightTexel light_texel(const RayFrame& frame, const RealVector& cells) {
  const TexelAxis z = texel_axis(frame, 0, cells.z);
  const TexelAxis a = texel_axis(frame, 1, cells.a);
  const TexelAxis b = texel_axis(frame, 2, cells.b);
  Real sums[4] = {hn::Zero(Floats{}), hn::Zero(Floats{}), hn::Zero(Floats{}), hn::Zero(Floats{})};
  for (int corner = 0; corner < 8; ++corner) {
    const auto share = [&](const TexelAxis& axis, bool above) {
      return above ? axis.to_above : hn::Sub(real(1), axis.to_above);
    };
    const bool up_z = (corner & 1) != 0, up_a = (corner & 2) != 0, up_b = (corner & 4) != 0;
    const Int at = hn::Add(up_z ? z.above : z.below,
                           hn::Add(up_a ? a.above : a.below, up_b ? b.above : b.below));
    const Int texel =
        hn::GatherIndex(Ints{}, reinterpret_cast<const std::int32_t*>(frame.light), at);
    const Real weight = hn::Mul(share(z, up_z), hn::Mul(share(a, up_a), share(b, up_b)));
    const auto add = [&](Real& sum, Int byte) {
      sum = hn::MulAdd(weight, hn::ConvertTo(Floats{}, hn::And(byte, whole(0xFF))), sum);
    };
    add(sums[0], texel);
    add(sums[1], hn::ShiftRight<8>(texel));
    add(sums[2], hn::ShiftRight<16>(texel));
    add(sums[3], hn::ShiftRight<24>(texel));
  }
  const auto slope = [](Real byte) { return hn::Mul(hn::Sub(byte, real(128)), real(1.0F / 127)); };
  return {slope(sums[0]), slope(sums[1]), slope(sums[2]), hn::Mul(sums[3], real(1.0F / 255))};
}

// By which what a ray shows, of that brightness (0…1), is weakened, if most of it lies at `sample` (a
// fraction between two). `unlit`: the share of it that shines by itself, as vessels do, about whose form
// tissue's slopes say nothing.
HWY_INLINE Real light_on(const RayFrame& frame, const Rays& rays, Real sample, Real brightness,
                         Real unlit) {
  const Real along_mm = hn::MulAdd(sample, real(frame.step_mm), rays.first_mm);
  const Real deep = hn::Mul(hn::Sub(hn::Mul(along_mm, rays.cosine), real(frame.cue_near_mm)),
                            real(frame.cue_per_mm));
  const Real fade =
      hn::NegMulAdd(hn::Min(hn::Max(deep, real(0)), real(1)), real(depth_cue), real(1));
  if (frame.light == nullptr)
    return fade;
  const auto cell = [&](int axis, Real direction) {
    return hn::MulAdd(direction, along_mm, real(frame.eye[axis]));
  };
  const LightTexel texel = light_texel(
      frame, {cell(0, rays.direction.z), cell(1, rays.direction.a), cell(2, rays.direction.b)});
  const Real squared =
      hn::MulAdd(texel.z, texel.z, hn::MulAdd(texel.a, texel.a, hn::Mul(texel.b, texel.b)));
  // Whichever of its sides is seen: the slope runs away from the eye, the lamp is on its side.
  const auto along = [&](Real z, Real a, Real b) {
    return hn::MulAdd(texel.z, z, hn::MulAdd(texel.a, a, hn::Mul(texel.b, b)));
  };
  const Real away = along(hn::Mul(rays.direction.z, real(frame.mm[0])),
                          hn::Mul(rays.direction.a, real(frame.mm[1])),
                          hn::Mul(rays.direction.b, real(frame.mm[2])));
  const Real lamp = along(real(-frame.lamp[0]), real(-frame.lamp[1]), real(-frame.lamp[2]));
  const Real towards = hn::Mul(lamp, hn::CopySign(real(1), away));
  const Real cosine = hn::Div(towards, hn::Sqrt(hn::Max(squared, real(1e-12F))));
  const Real half = hn::MulAdd(cosine, real(0.5F), real(0.5F));
  const Real lit = hn::MulAdd(hn::Mul(half, half), real(1 - ambient_light), real(ambient_light));
  const Real strength = hn::Div(squared, hn::Add(squared, real(weak_slope * weak_slope)));
  const Real surface = hn::MulAdd(strength, hn::Sub(lit, real(level_light)), real(level_light));
  const Real open =
      hn::Min(hn::Max(hn::Sub(real(open_light), texel.density), real(least_open)), real(1));
  const Real shade = hn::Mul(surface, open);
  const Real bright =
      hn::Mul(hn::Sub(brightness, real(gleam_from)), real(1 / (gleam_to - gleam_from)));
  const Real above = hn::Min(hn::Max(bright, real(0)), real(1));
  const Real gleam = hn::Mul(hn::Mul(above, above), hn::NegMulAdd(above, real(2), real(3)));
  const Real own = hn::Max(gleam, unlit);
  return hn::Mul(hn::MulAdd(own, hn::Sub(real(1), shade), shade), fade);
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace octascope::ui::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
