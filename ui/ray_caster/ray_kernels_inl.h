// Traces packets of rays, front to back. For one instruction set; see ray_kernels.h.
#if defined(OCTASCOPE_RAY_KERNELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_RAY_KERNELS_INL
#undef OCTASCOPE_RAY_KERNELS_INL
#else
#define OCTASCOPE_RAY_KERNELS_INL
#endif

#include <hwy/highway.h>

#include "ui/ray_caster/ray_kernels.h"

#if HWY_TARGET == HWY_SCALAR // no permutations of bytes: GL draws on such processors

HWY_BEFORE_NAMESPACE();
namespace octascope::ui::HWY_NAMESPACE {

const RayKernels* kernels() {
  return nullptr;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace octascope::ui::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#else

#include <algorithm>

#include "ui/ray_caster/ray_light_inl.h"
#include "ui/transfer/depth_colours.h"
#include "ui/transfer/flow_look.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::ui::HWY_NAMESPACE {

inline constexpr int square_size = 16; // pixels whose packets are traced alternately
static_assert(tile_size % square_size == 0 && square_size % packet_height == 0);
inline constexpr int samples_per_check = 4; // between two checks for empty bricks

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

// A sample whose loads are in progress.
struct Sample {
  Position position;
  Int number;
  IntMask valid;
  Cell cell;
  Int flow_near, flow_far; // the same corners of what flows
};

template <Flow Flows>
HWY_INLINE Sample begin_sample(const RayFrame& frame, const Rays& rays, const Position& position,
                               Int number) {
  const IntMask valid = hn::Lt(number, rays.end);
  Sample sample{
      position,         number,          valid, fetch_cell(frame, frame.cells, position, valid),
      hn::Zero(Ints{}), hn::Zero(Ints{})};
  if constexpr (Flows == Flow::here) {
    const Cell flow = fetch_cell(frame, frame.flow_cells, position, valid);
    sample.flow_near = flow.near;
    sample.flow_far = flow.far;
  }
  return sample;
}

template <Look How, Flow Flows>
HWY_INLINE Substance classify(const RayFrame& frame, const Sample& sample) {
  Substance tissue =
      classify_level<How>(frame, sample.position, interpolate(sample.cell), sample.valid);
  if constexpr (Flows != Flow::none && !has_hue(How, Flow::none)) {
    tissue.green = tissue.red;
    tissue.blue = tissue.red;
  }
  if constexpr (Flows == Flow::here) {
    Cell flow = sample.cell;
    flow.near = sample.flow_near;
    flow.far = sample.flow_far;
    add_flow(hn::IfThenElseZero(sample.valid,
                                table_entry(frame.flow_opacity_and_weight, interpolate(flow))),
             tissue);
  }
  return tissue;
}

template <bool Shaded, Look How, Flow Flows>
HWY_INLINE void add_sample(const RayFrame& frame, const Sample& sample, Light& light) {
  const Substance here = classify<How, Flows>(frame, sample);
  light.half_opaque = hn::IfThenElse(hn::RebindMask(Ints{}, hn::Ge(light.transparency, real(0.5F))),
                                     sample.number, light.half_opaque);
  const Real weight = hn::Mul(light.transparency, here.opacity);
  light.transparency = hn::Sub(light.transparency, weight);
  if constexpr (Shaded) {
    const Real square = hn::Mul(weight, weight);
    const Real power = hn::Mul(square, square);
    light.powers = hn::Add(light.powers, power);
    light.numbers = hn::MulAdd(power, hn::ConvertTo(Floats{}, sample.number), light.numbers);
    if constexpr (Flows == Flow::here)
      light.flow = hn::MulAdd(weight, here.flow, light.flow);
  }
  light.red = hn::MulAdd(weight, here.red, light.red);
  if constexpr (has_hue(How, Flows)) {
    light.green = hn::MulAdd(weight, here.green, light.green);
    light.blue = hn::MulAdd(weight, here.blue, light.blue);
  }
}

// If the packet's first ray is in tissue, most others are too: checking each does not pay.
HWY_INLINE bool first_ray_in_tissue(const RayFrame& frame, const Rays& rays) {
  if (hn::GetLane(rays.next) >= hn::GetLane(rays.end))
    return false;
  const std::int32_t brick = (hn::GetLane(rays.position.b) >> brick_b_shift) * frame.brick_slab +
                             (hn::GetLane(rays.position.a) >> brick_a_shift) * frame.brick_row +
                             (hn::GetLane(rays.position.z) >> brick_z_shift) +
                             hn::GetLane(rays.octant);
  return (frame.bricks[brick] & 0xFF) == 0;
}

// Moves active lanes out of empty bricks while at least half of them are in one. The few others
// sample empty space, which does not change the picture.
HWY_INLINE void leap_empty_bricks(const RayFrame& frame, Rays& rays) {
  if (first_ray_in_tissue(frame, rays))
    return;
  std::size_t leaping = 1, all = 1;
  while (2 * leaping >= all) {
    const IntMask active = rays.active();
    const Int distance =
        hn::And(brick_at(frame, frame.bricks, rays.octant, rays.position, active), whole(0xFF));
    const IntMask empty = hn::And(active, hn::Gt(distance, hn::Zero(Ints{})));
    leaping = hn::CountTrue(Ints{}, empty);
    if (leaping == 0)
      return;
    all = hn::CountTrue(Ints{}, active);
    const Int samples = samples_to_leap(rays.axes, rays.position, hn::Sub(distance, whole(1)));
    rays.leap(hn::IfThenElseZero(empty, samples));
  }
}

// Whether something may flow at any ray's next few samples. `still_before`: up to which sample of each
// ray nothing is known to.
HWY_INLINE bool meets_flow(const RayFrame& frame, const Rays& rays, Int& still_before) {
  const Int needed = hn::Min(hn::Add(rays.next, whole(samples_per_check)), rays.end);
  // Not of rays that have ended: their positions may lie outside of all bricks.
  const IntMask open = hn::And(rays.active(), hn::Lt(still_before, needed));
  if (hn::AllFalse(Ints{}, open))
    return false;
  const Int distance =
      hn::And(brick_at(frame, frame.flow_bricks, rays.octant, rays.position, open), whole(0xFF));
  const IntMask empty = hn::And(open, hn::Gt(distance, hn::Zero(Ints{})));
  const Int more = hn::Max(hn::Sub(distance, whole(1)), hn::Zero(Ints{}));
  const Int samples = samples_to_leap(rays.axes, rays.position, more);
  still_before = hn::IfThenElse(empty, hn::Add(rays.next, samples), still_before);
  return !hn::AllFalse(Ints{}, hn::And(open, hn::Lt(still_before, needed)));
}

// Advances by a few samples.
template <bool Shaded, Look How, Flow Flows>
HWY_INLINE void take_samples(const RayFrame& frame, Rays& rays, Light& light) {
  // Software pipelining: starts the loads of a sample while the previous one is processed; the
  // processor's out-of-order window is too short to do this by itself.
  Light result = light;
  Sample sample = begin_sample<Flows>(frame, rays, rays.position, rays.next);
  for (int i = 1; i < samples_per_check; ++i) {
    const Position ahead{hn::Add(sample.position.z, rays.axes.z.step),
                         hn::Add(sample.position.a, rays.axes.a.step),
                         hn::Add(sample.position.b, rays.axes.b.step)};
    const Sample next = begin_sample<Flows>(frame, rays, ahead, hn::Add(sample.number, whole(1)));
    add_sample<Shaded, How, Flows>(frame, sample, result);
    sample = next;
  }
  add_sample<Shaded, How, Flows>(frame, sample, result);
  rays.position = sample.position;
  rays.next = sample.number;
  rays.step();
  const RealMask opaque = hn::Lt(result.transparency, real(opaque_transparency));
  rays.end = hn::IfThenZeroElse(hn::RebindMask(Ints{}, opaque), rays.end);
  light = result;
}

// The same, but for empty bricks; false when all rays have ended.
template <bool Shaded, Look How, bool WithFlow>
HWY_INLINE bool advance(const RayFrame& frame, Rays& rays, Int& still_before, Light& light) {
  leap_empty_bricks(frame, rays);
  if (hn::AllFalse(Ints{}, rays.active()))
    return false;
  if constexpr (!WithFlow)
    take_samples<Shaded, How, Flow::none>(frame, rays, light);
  else if (meets_flow(frame, rays, still_before))
    take_samples<Shaded, How, Flow::here>(frame, rays, light);
  else
    take_samples<Shaded, How, Flow::elsewhere>(frame, rays, light);
  return true;
}

template <bool Shaded, bool HasHue>
HWY_INLINE void complete(const RayFrame& frame, const Rays& rays, Light& light) {
  const RealMask opaque = hn::Lt(light.transparency, real(opaque_transparency));
  Real share = hn::IfThenElse(opaque, hn::Sub(real(1), light.transparency), real(1));
  if constexpr (Shaded) {
    const Real strongest =
        HasHue ? hn::Max(light.red, hn::Max(light.green, light.blue)) : light.red;
    const Real opacity = hn::Max(hn::Sub(real(1), light.transparency), real(1e-6F));
    const Real brightness = hn::Min(hn::Div(strongest, hn::Mul(opacity, real(65535))), real(1));
    share = hn::Div(share, light_on(frame, rays, light.main_sample(), brightness,
                                    hn::Div(light.flow, opacity)));
  }
  light.transparency = hn::IfThenZeroElse(opaque, light.transparency);
  light.red = hn::Div(light.red, share);
  light.green = HasHue ? hn::Div(light.green, share) : light.red;
  light.blue = HasHue ? hn::Div(light.blue, share) : light.red;
}

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
      const Int level = hn::IfThenElseZero(
          valid, interpolate(fetch_cell(frame, frame.cells, rays.position, valid)));
      highest.sample = hn::IfThenElse(hn::Gt(level, highest.level), rays.next, highest.sample);
      highest.level = hn::Max(level, highest.level);
      rays.step();
    }
  }
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

// The packets of a square take turns, so that each uses what its neighbours have loaded into the
// first-level cache.
template <bool Shaded, Look How, bool WithFlow>
void draw_square(const RayFrame& frame, int left, int top) {
  constexpr int across = square_size / packet_width;
  constexpr int packets = across * (square_size / packet_height);
  Rays rays[packets];
  Light light[packets];
  Int still_before[WithFlow ? packets : 1]; // meets_flow()
  int live[packets];
  int lives = 0;
  for (int i = 0; i < packets; ++i) {
    rays[i] = make_rays(frame, left + i % across * packet_width, top + i / across * packet_height);
    light[i] = Light::none();
    still_before[WithFlow ? i : 0] = hn::Zero(Ints{});
    live[lives++] = i;
  }
  while (lives > 0) {
    int kept = 0;
    for (int i = 0; i < lives; ++i)
      if (advance<Shaded, How, WithFlow>(frame, rays[live[i]], still_before[WithFlow ? live[i] : 0],
                                         light[live[i]]))
        live[kept++] = live[i];
    lives = kept;
  }
  for (int i = 0; i < packets; ++i) {
    const int x = left + i % across * packet_width;
    const int y = top + i / across * packet_height;
    if (x >= frame.width || y >= frame.height)
      continue;
    const Real depth = hn::IfThenElse(hn::Ge(light[i].transparency, real(0.5F)), real(no_depth),
                                      rays[i].depth_mm(frame, light[i].half_opaque));
    complete<Shaded, WithFlow || has_hue(How, Flow::none)>(frame, rays[i], light[i]);
    store(frame, x, y, to_rgba(light[i], hn::Sub(real(1), light[i].transparency)), depth);
  }
}

template <bool Shaded, Look How, bool WithFlow>
void draw_composite(const RayFrame& frame, Tile tile) {
  const int right = std::min(tile.x + tile_size, frame.width);
  const int bottom = std::min(tile.y + tile_size, frame.height);
  for (int y = tile.y; y < bottom; y += square_size)
    for (int x = tile.x; x < right; x += square_size)
      draw_square<Shaded, How, WithFlow>(frame, x, y);
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
      const IntMask valid = rays.active();
      const Int flow = interpolate(fetch_cell(frame, frame.flow_cells, rays.position, valid));
      const Int entry = hn::IfThenElseZero(valid, table_entry(frame.flow_opacity_and_weight, flow));
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

const RayKernels* kernels() {
#define OCTASCOPE_LOOKS(shaded)                                                                    \
  {                                                                                                \
    &draw_composite<shaded, Look::grey, false>, &draw_composite<shaded, Look::coloured, false>,    \
        &draw_composite<shaded, Look::ramp, false>, &draw_composite<shaded, Look::by_depth, false> \
  }
// A grey beside flow has hues anyway.
#define OCTASCOPE_LOOKS_WITH_FLOW(shaded)                                                          \
  {                                                                                                \
    &draw_composite<shaded, Look::coloured, true>, &draw_composite<shaded, Look::coloured, true>,  \
        &draw_composite<shaded, Look::ramp, true>, &draw_composite<shaded, Look::by_depth, true>   \
  }
  static const RayKernels table{
      hwy::TargetName(HWY_TARGET),
      {OCTASCOPE_LOOKS(false), OCTASCOPE_LOOKS(true), &draw_maximum<false>},
      {OCTASCOPE_LOOKS_WITH_FLOW(false), OCTASCOPE_LOOKS_WITH_FLOW(true), &draw_maximum<true>}};
#undef OCTASCOPE_LOOKS_WITH_FLOW
#undef OCTASCOPE_LOOKS
  return &table;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace octascope::ui::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // HWY_SCALAR

#endif
