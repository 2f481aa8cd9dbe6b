// What a level, a depth and flow look like, and the light that a ray brings. For one instruction
// set; see ray_kernels.h.
#if defined(OCTASCOPE_RAY_COLOUR_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_RAY_COLOUR_INL
#undef OCTASCOPE_RAY_COLOUR_INL
#else
#define OCTASCOPE_RAY_COLOUR_INL
#endif

#include <hwy/highway.h>

#include "ui/ray_caster/light_volume.h"
#include "ui/ray_caster/ray_packet_inl.h"
#include "ui/ray_caster/ray_sampling_inl.h"
#include "ui/transfer/depth_colours.h"
#include "ui/transfer/flow_look.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::ui::HWY_NAMESPACE {

// The light accumulated in the lanes of a packet.
struct Light {
  Real red, green, blue; // premultiplied, 0…65535
  Real transparency;
  Int half_opaque; // the sample at which half the opacity was reached
  // Where most of it comes from: the mean of the samples' numbers, by the fourth powers of their
  // weights, so that of two layers the stronger has it. For "shaded" alone.
  Real powers, numbers;
  Real flow; // the share of the opacity that flows, likewise

  HWY_INLINE static Light none() {
    return {hn::Zero(Floats{}), hn::Zero(Floats{}), hn::Zero(Floats{}), real(1),
            hn::Zero(Ints{}),   hn::Zero(Floats{}), hn::Zero(Floats{}), hn::Zero(Floats{})};
  }
  HWY_INLINE Real main_sample() const {
    return hn::Div(numbers, hn::Max(powers, real(least_power)));
  }
};

HWY_INLINE Real lower_16_bits(Int v) {
  return hn::ConvertTo(Floats{}, hn::And(v, whole(0xFFFF)));
}
HWY_INLINE Real upper_16_bits(Int v) {
  using Unsigned = hn::RebindToUnsigned<Ints>;
  return hn::ConvertTo(Floats{},
                       hn::BitCast(Ints{}, hn::ShiftRight<16>(hn::BitCast(Unsigned{}, v))));
}

// One sample: opacity 0…1, colours 0…65535.
struct Substance {
  Real opacity, red, green, blue;
  Real flow; // weight
};

// What a piece of a ray sees of flow: its kernel knows none; there may be some; there is none here.
enum class Flow : std::uint8_t { none, here, elsewhere };

constexpr bool has_hue(Look look, Flow flow) {
  return look == Look::coloured || look == Look::by_depth || flow != Flow::none;
}

// What a grey is multiplied with at a depth in cells.
struct Tint {
  Real red, green, blue;
};
HWY_INLINE Tint tint_at(const RayFrame& frame, Real cells) {
  const Real along = hn::MulAdd(cells, real(frame.tint_scale), real(frame.tint_offset));
  const Real place = hn::Min(hn::Max(along, real(0)), real(1));
  const auto channel = [&](std::size_t of) {
    const auto& cubic = depth_tint_cubics[of];
    return hn::MulAdd(
        hn::MulAdd(hn::MulAdd(real(cubic[3]), place, real(cubic[2])), place, real(cubic[1])), place,
        real(cubic[0]));
  };
  return {channel(0), channel(1), channel(2)};
}
HWY_INLINE Real depth_cells(const Position& position) {
  return hn::Mul(hn::ConvertTo(Floats{}, position.z), real(1.0F / one_cell));
}

template <Look How>
HWY_INLINE Substance classify_level(const RayFrame& frame, const Position& position, Int level,
                                    IntMask valid) {
  if constexpr (How == Look::ramp) {
    constexpr float per_level = 1.0F / (1 << level_shift);
    constexpr float rounded_up = 1.0F / (2 * TransferTable::entries_per_level);
    const Real ramp = hn::MulAdd(hn::ConvertTo(Floats{}, level), real(frame.ramp_scale * per_level),
                                 real(frame.ramp_offset - rounded_up * frame.ramp_scale));
    const Real inside = hn::Min(hn::Max(ramp, real(0)), real(1));
    const Real grey = hn::IfThenElseZero(hn::RebindMask(Floats{}, valid), inside);
    // In pairs, to halve the chain of dependent operations.
    const auto pair = [&](int power) {
      return hn::MulAdd(grey, real(frame.ramp_opacity[power + 1]), real(frame.ramp_opacity[power]));
    };
    const Real square = hn::Mul(grey, grey);
    const Real sum = hn::MulAdd(hn::MulAdd(pair(4), square, pair(2)), square, pair(0));
    return {hn::Mul(sum, grey), hn::Mul(grey, real(65535)), real(0), real(0), real(0)};
  } else {
    const Int entry = hn::IfThenElseZero(valid, table_entry(frame.opacity_and_red, level));
    Substance substance{hn::Mul(upper_16_bits(entry), real(1.0F / 65535)), lower_16_bits(entry),
                        real(0), real(0), real(0)};
    if constexpr (How == Look::coloured) {
      const Int others = table_entry(frame.green_and_blue, level);
      substance.green = upper_16_bits(others);
      substance.blue = lower_16_bits(others);
    }
    if constexpr (How == Look::by_depth) {
      const Tint tint = tint_at(frame, depth_cells(position));
      substance.green = hn::Mul(substance.red, tint.green);
      substance.blue = hn::Mul(substance.red, tint.blue);
      substance.red = hn::Mul(substance.red, tint.red);
    }
    return substance;
  }
}

// Towards the colour of flow, by its weight.
HWY_INLINE Real mix_flow(Real tissue, float wall, float middle, Real weight) {
  const Real flow = hn::MulAdd(weight, real(65535 * (middle - wall)), real(65535 * wall));
  return hn::MulAdd(weight, hn::Sub(flow, tissue), tissue);
}

// What flows in tissue, by the table's entry. An entry of 0 changes nothing.
HWY_INLINE void add_flow(Int entry, Substance& tissue) {
  const Real weight = hn::Mul(lower_16_bits(entry), real(1.0F / 65535));
  tissue.flow = weight;
  tissue.opacity = hn::Max(tissue.opacity, hn::Mul(upper_16_bits(entry), real(1.0F / 65535)));
  tissue.red = mix_flow(tissue.red, flow_wall.red, flow_middle.red, weight);
  tissue.green = mix_flow(tissue.green, flow_wall.green, flow_middle.green, weight);
  tissue.blue = mix_flow(tissue.blue, flow_wall.blue, flow_middle.blue, weight);
}

HWY_INLINE Int to_rgba(const Light& light, Real opacity) {
  const auto to_8_bits = [](Real v, float scale) {
    return hn::NearestInt(hn::Min(hn::Mul(v, real(scale)), real(255)));
  };
  constexpr float from_16_bits = 255.0F / 65535;
  return hn::Or(hn::Or(to_8_bits(light.red, from_16_bits),
                       hn::ShiftLeft<8>(to_8_bits(light.green, from_16_bits))),
                hn::Or(hn::ShiftLeft<16>(to_8_bits(light.blue, from_16_bits)),
                       hn::ShiftLeft<24>(to_8_bits(opacity, 255))));
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace octascope::ui::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
