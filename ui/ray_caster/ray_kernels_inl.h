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

#include "ui/ray_caster/ray_colour_inl.h"
#include "ui/ray_caster/ray_light_inl.h"
#include "ui/ray_caster/ray_maximum_inl.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::ui::HWY_NAMESPACE {

inline constexpr int square_size = 16; // pixels whose packets are traced alternately
static_assert(tile_size % square_size == 0 && square_size % packet_height == 0);

HWY_INLINE IntMask no_rays() {
  return hn::MaskFromVec(hn::Zero(Ints{}));
}

// A sample whose loads are in progress.
struct Sample {
  Position position;
  Int number;
  IntMask valid;
  Cell cell;
  Int flow_near, flow_far; // the same corners of what flows
  IntMask flows;           // else nothing does
};

// `may_flow`: the rays that are in what flows. Others would only fetch what nobody looks at.
template <Flow Flows>
HWY_INLINE Sample begin_sample(const RayFrame& frame, const Rays& rays, const Position& position,
                               Int number, IntMask may_flow) {
  const IntMask valid = hn::Lt(number, rays.end);
  Sample sample{position,         number,           valid,   fetch_cell(frame, position, valid),
                hn::Zero(Ints{}), hn::Zero(Ints{}), may_flow};
  if constexpr (Flows == Flow::here) {
    sample.flows = flows_at(frame, position, hn::And(valid, may_flow));
    if (!hn::AllFalse(Ints{}, sample.flows)) {
      const Cell flow = fetch_flow(frame, position, sample.flows);
      sample.flow_near = flow.near;
      sample.flow_far = flow.far;
    }
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
    add_flow(hn::IfThenElseZero(sample.flows,
                                table_entry(frame.flow_opacity_and_weight, interpolate(flow))),
             tissue);
  }
  return tissue;
}

template <bool Shaded, bool HasHue, bool Flows>
HWY_INLINE void add_substance(const Substance& here, Int number, Light& light) {
  light.half_opaque = hn::IfThenElse(hn::RebindMask(Ints{}, hn::Ge(light.transparency, real(0.5F))),
                                     number, light.half_opaque);
  const Real weight = hn::Mul(light.transparency, here.opacity);
  light.transparency = hn::Sub(light.transparency, weight);
  if constexpr (Shaded) {
    const Real square = hn::Mul(weight, weight);
    const Real power = hn::Mul(square, square);
    light.powers = hn::Add(light.powers, power);
    light.numbers = hn::MulAdd(power, hn::ConvertTo(Floats{}, number), light.numbers);
    if constexpr (Flows)
      light.flow = hn::MulAdd(weight, here.flow, light.flow);
  }
  light.red = hn::MulAdd(weight, here.red, light.red);
  if constexpr (HasHue) {
    light.green = hn::MulAdd(weight, here.green, light.green);
    light.blue = hn::MulAdd(weight, here.blue, light.blue);
  }
}

template <bool Shaded, Look How, Flow Flows>
HWY_INLINE void add_sample(const RayFrame& frame, const Sample& sample, Light& light) {
  add_substance<Shaded, has_hue(How, Flows), Flows == Flow::here>(
      classify<How, Flows>(frame, sample), sample.number, light);
}

HWY_INLINE void end_opaque(const Light& light, Rays& rays) {
  const RealMask opaque = hn::Lt(light.transparency, real(opaque_transparency));
  rays.end = hn::IfThenZeroElse(hn::RebindMask(Ints{}, opaque), rays.end);
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
    Int samples = hn::IfThenElseZero(
        empty, samples_to_leap(rays.axes, rays.position, hn::Sub(distance, whole(1))));
    // One sample stands for several: always the same one.
    if (frame.coarse_beside_flow)
      samples = hn::AndNot(whole(samples_of_haze - 1), samples);
    leaping = hn::CountTrue(Ints{}, hn::Gt(samples, hn::Zero(Ints{})));
    if (leaping == 0)
      return;
    all = hn::CountTrue(Ints{}, active);
    rays.leap(samples);
  }
}

// The rays at whose next few samples something may flow. `still_before`: up to which sample of each
// ray nothing is known to.
HWY_INLINE IntMask meet_flow(const RayFrame& frame, const Rays& rays, Int& still_before) {
  const int few = frame.coarse_beside_flow ? samples_of_haze : samples_per_check;
  const Int needed = hn::Min(hn::Add(rays.next, whole(few)), rays.end);
  // Not of rays that have ended: their positions may lie outside of all bricks.
  const IntMask open = hn::And(rays.active(), hn::Lt(still_before, needed));
  if (hn::AllFalse(Ints{}, open))
    return open;
  const Int distance =
      hn::And(brick_at(frame, frame.flow_bricks, rays.octant, rays.position, open), whole(0xFF));
  const IntMask empty = hn::And(open, hn::Gt(distance, hn::Zero(Ints{})));
  const Int more = hn::Max(hn::Sub(distance, whole(1)), hn::Zero(Ints{}));
  const Int samples = samples_to_leap(rays.axes, rays.position, more);
  still_before = hn::IfThenElse(empty, hn::Add(rays.next, samples), still_before);
  return hn::And(open, hn::Lt(still_before, needed));
}

// Advances by a few samples.
template <bool Shaded, Look How, Flow Flows>
HWY_INLINE void take_samples(const RayFrame& frame, IntMask may_flow, Rays& rays, Light& light) {
  // Software pipelining: starts the loads of a sample while the previous one is processed; the
  // processor's out-of-order window is too short to do this by itself.
  Light result = light;
  Sample sample = begin_sample<Flows>(frame, rays, rays.position, rays.next, may_flow);
  for (int i = 1; i < samples_per_check; ++i) {
    const Position ahead{hn::Add(sample.position.z, rays.axes.z.step),
                         hn::Add(sample.position.a, rays.axes.a.step),
                         hn::Add(sample.position.b, rays.axes.b.step)};
    const Sample next =
        begin_sample<Flows>(frame, rays, ahead, hn::Add(sample.number, whole(1)), may_flow);
    add_sample<Shaded, How, Flows>(frame, sample, result);
    sample = next;
  }
  add_sample<Shaded, How, Flows>(frame, sample, result);
  rays.position = sample.position;
  rays.next = sample.number;
  rays.step();
  end_opaque(result, rays);
  light = result;
}

// One of the next samples, which stands for the tissue of all of them: it is weak where flow is shown.
// Another one in each pixel around, or shells would be seen.
struct TissueAhead {
  Position position;
  Int number;
};
HWY_INLINE TissueAhead tissue_ahead(const Rays& rays) {
  const Int last = hn::Sub(hn::Sub(rays.end, rays.next), whole(1));
  const Int ahead = hn::Min(rays.chosen, hn::Max(last, hn::Zero(Ints{})));
  const auto at = [&](Int from, Int step) { return hn::Add(from, hn::Mul(step, ahead)); };
  return {{at(rays.position.z, rays.axes.z.step), at(rays.position.a, rays.axes.a.step),
           at(rays.position.b, rays.axes.b.step)},
          hn::Add(rays.next, ahead)};
}
HWY_INLINE Sample begin_tissue(const RayFrame& frame, const Rays& rays) {
  const TissueAhead ahead = tissue_ahead(rays);
  return begin_sample<Flow::elsewhere>(frame, rays, ahead.position, ahead.number, no_rays());
}

// Few lanes'.
HWY_INLINE void prefetch_flow(const RayFrame& frame, const Position& p, IntMask valid) {
  if (hn::AllFalse(Ints{}, valid))
    return;
  const Edges at = flow_edges(frame, p, valid);
  alignas(64) std::int32_t offsets[4][lanes];
  hn::Store(at.near_first, Ints{}, offsets[0]);
  hn::Store(at.near_second, Ints{}, offsets[1]);
  hn::Store(at.far_first, Ints{}, offsets[2]);
  hn::Store(at.far_second, Ints{}, offsets[3]);
  alignas(8) std::uint8_t bits[8] = {};
  hn::StoreMaskBits(Ints{}, valid, bits);
  for (unsigned left = bits[0] | static_cast<unsigned>(bits[1]) << 8U; left != 0; left &= left - 1)
    for (const auto& edge : offsets)
      __builtin_prefetch(frame.flow + edge[std::countr_zero(left)]);
}

// Of the next few samples of each ray: where something may be seen to flow. It is fetched ahead.
struct FlowAhead {
  IntMask flows[samples_of_haze];
  IntMask anywhere;
  bool any = false; // else the rest is undefined
};
HWY_INLINE FlowAhead find_flow(const RayFrame& frame, Rays rays, IntMask may_flow) {
  FlowAhead ahead;
  ahead.anywhere = no_rays();
  for (IntMask& flows : ahead.flows) {
    flows = flows_at(frame, rays.position, hn::And(may_flow, rays.active()));
    ahead.anywhere = hn::Or(ahead.anywhere, flows);
    prefetch_flow(frame, rays.position, flows);
    rays.step();
  }
  ahead.any = !hn::AllFalse(Ints{}, ahead.anywhere);
  return ahead;
}

// Adds the tissue of the next few samples of each ray; advances none.
template <bool WithHue>
HWY_INLINE void add_tissue(const Rays& rays, const Substance& sample, Int number, Light& light) {
  Substance all = sample;
  const Int left = hn::Sub(rays.end, rays.next);
  for (int more = 1; more < samples_of_haze; ++more) {
    const RealMask is_there = hn::RebindMask(Floats{}, hn::Gt(left, whole(more)));
    const Real added = hn::Mul(hn::Sub(real(1), all.opacity), sample.opacity);
    all.opacity = hn::Add(all.opacity, hn::IfThenElseZero(is_there, added));
  }
  add_substance<false, WithHue, false>(all, number, light);
}

// Light of one of two, of a ray that is not shaded.
HWY_INLINE Light select(IntMask first, const Light& a, const Light& b) {
  const RealMask mask = hn::RebindMask(Floats{}, first);
  Light light = b;
  light.red = hn::IfThenElse(mask, a.red, b.red);
  light.green = hn::IfThenElse(mask, a.green, b.green);
  light.blue = hn::IfThenElse(mask, a.blue, b.blue);
  light.transparency = hn::IfThenElse(mask, a.transparency, b.transparency);
  light.half_opaque = hn::IfThenElse(first, a.half_opaque, b.half_opaque);
  return light;
}

// Adds all that flows in such tissue.
HWY_INLINE void add_flow_in(const RayFrame& frame, Rays rays, const Substance& tissue,
                            const FlowAhead& ahead, Light& light) {
  for (const IntMask& flows : ahead.flows) {
    Substance both = tissue;
    both.opacity = hn::IfThenElseZero(hn::RebindMask(Floats{}, rays.active()), both.opacity);
    if (!hn::AllFalse(Ints{}, flows)) {
      const Int flow = interpolate(fetch_flow(frame, rays.position, flows));
      add_flow(hn::IfThenElseZero(flows, table_entry(frame.flow_opacity_and_weight, flow)), both);
    }
    add_substance<false, true, true>(both, rays.next, light);
    rays.step();
  }
}

// Advances by as many. A ray's light is the same whatever its neighbours meet: which of them are with it
// changes with what it need not be drawn anew for.
template <Look How>
HWY_INLINE void take_coarsely(const RayFrame& frame, IntMask may_flow, Rays& rays, Light& light) {
  FlowAhead ahead;
  if (!hn::AllFalse(Ints{}, may_flow))
    ahead = find_flow(frame, rays, may_flow);
  const Sample sample = begin_tissue(frame, rays);
  const Substance tissue = classify<How, Flow::elsewhere>(frame, sample);
  Light still = light;
  add_tissue<true>(rays, tissue, sample.number, still);
  if (ahead.any) {
    Light flowing = light;
    add_flow_in(frame, rays, tissue, ahead, flowing);
    still = select(ahead.anywhere, flowing, still);
  }
  light = still;
  rays.leap(whole(samples_of_haze));
  end_opaque(light, rays);
}

// The same, but for empty bricks; false when all rays have ended.
template <bool Shaded, Look How, bool WithFlow>
HWY_INLINE bool advance(const RayFrame& frame, Rays& rays, Int& still_before, Light& light) {
  leap_empty_bricks(frame, rays);
  if (hn::AllFalse(Ints{}, rays.active()))
    return false;
  if constexpr (!WithFlow) {
    take_samples<Shaded, How, Flow::none>(frame, no_rays(), rays, light);
  } else {
    const IntMask may_flow = meet_flow(frame, rays, still_before);
    const bool flows = !hn::AllFalse(Ints{}, may_flow);
    if (!Shaded && frame.coarse_beside_flow) {
      take_coarsely<How>(frame, may_flow, rays, light);
      // So few samples lie in a cache line that each would be waited for at the packet's next turn.
      prefetch_cells(frame, tissue_ahead(rays).position, rays.active());
    } else if (flows) {
      take_samples<Shaded, How, Flow::here>(frame, may_flow, rays, light);
    } else {
      take_samples<Shaded, How, Flow::elsewhere>(frame, no_rays(), rays, light);
    }
  }
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

// The packets of a square take turns, so that each uses what its neighbours have loaded into the
// first-level cache.
template <bool Shaded, Look How, bool WithFlow>
void draw_square(const RayFrame& frame, int left, int top) {
  constexpr int across = square_size / packet_width;
  constexpr int packets = across * (square_size / packet_height);
  Rays rays[packets];
  Light light[packets];
  Int still_before[WithFlow ? packets : 1]; // meet_flow()
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
