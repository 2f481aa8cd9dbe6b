// Selects the segments of packed nodes that may cover a pixel centre. For one instruction set; see
// splat_kernels.h.
//
// In a view of the whole tree, millions of segments are much thinner than a pixel and no longer
// than one; nearly all of them cover no pixel centre. So a cluster's nodes are projected into
// arrays that fit the first-level cache, and a first test of many segments at a time keeps those
// whose bounding rectangle contains a centre.
#if defined(OCTASCOPE_SPLAT_KERNELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef OCTASCOPE_SPLAT_KERNELS_INL
#undef OCTASCOPE_SPLAT_KERNELS_INL
#else
#define OCTASCOPE_SPLAT_KERNELS_INL
#endif

#include <hwy/contrib/math/math-inl.h>
#include <hwy/highway.h>

#include "ui/vessels/splatter/splat_kernels.h"

#if HWY_TARGET == HWY_SCALAR // GL draws on such processors

HWY_BEFORE_NAMESPACE();
namespace octascope::ui::HWY_NAMESPACE {

const SplatKernels* splat_kernels_of_target() {
  return nullptr;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace octascope::ui::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#else

#include <algorithm>
#include <cmath>
#include <cstring>

#include "ui/vessels/splatter/cluster_view.h"
#include "ui/vessels/splatter/merged_order.h"
#include "ui/vessels/splatter/splat_shapes_inl.h"
#include "ui/vessels/splatter/splat_smoothing_inl.h"

HWY_BEFORE_NAMESPACE();
namespace octascope::ui::HWY_NAMESPACE {
namespace splat {

class ClusterSplatter {
public:
  explicit ClusterSplatter(const SplatFrame& frame)
      : frame_{frame}, fragments_{frame}, queues_{{frame, fragments_},
                                                  {frame, fragments_},
                                                  {frame, fragments_}} {}

  HWY_INLINE void splat(std::uint32_t index) {
    const pipeline::VesselCluster& cluster = frame_.tree.clusters[index];
    const std::size_t taken = frame_.taken.empty() ? cluster.references : frame_.taken[index];
    if (taken == cluster.nodes)
      return;
    const ClusterView view{frame_, cluster};
    if (view.outside()) {
      counts_.culled += cluster.nodes - taken;
      return;
    }
    const pipeline::PackedNode* nodes = frame_.tree.nodes.data() + cluster.first_node;
    if (HWY_UNLIKELY(view.crosses_near())) {
      splat_clipped(cluster, view, nodes, taken);
      return;
    }
    const std::size_t thin =
        std::max<std::size_t>(taken, cluster.nodes_from_order[least_order_kept_visible]);
    if (frame_.detail_px > 0) {
      splat_merged(cluster, view, nodes, taken, thin);
      return;
    }
    project(cluster, view, nodes, cluster.nodes);
    find_parents(cluster);
    const auto start = [this](std::size_t i) { return start_of(i); };
    choose(taken, thin, kept_visible_reach, view.inside());
    add_chosen(cluster, nodes, start);
    choose(thin, cluster.nodes, 0, view.inside());
    add_chosen(cluster, nodes, start);
  }

  SplatCounts finish() {
    for (std::size_t kind = 0; kind < kinds; ++kind)
      queues_[kind].finish(kind == one_centre);
    fragments_.finish();
    return counts_;
  }

private:
  static constexpr std::size_t room = 256 + lanes;
  static constexpr std::size_t nodes_a_cache_line = 8;
  // A quarter of the time went by in waiting for nodes: clusters lie one behind the other.
  static constexpr std::size_t nodes_ahead = 160;
  static constexpr float kept_visible_reach = least_vessel_radius_px + 1e-3F;

  // By how many pixel centres they may cover: alike ones are drawn together, because lanes wait for
  // the slowest.
  enum Kind : std::uint32_t { one_centre, few_centres, more_centres, kinds };
  static constexpr float most_few_px =
      3; // from the first sides of its rectangle to its last centre
  static constexpr unsigned kind_shift = 16; // of chosen indices

  // Ends of segments. Most are looked at for their place alone.
  struct Ends {
    HWY_INLINE End at(std::size_t i) const {
      return {places[2 * i], places[2 * i + 1], nearness[i], log2_radii[i]};
    }
    HWY_INLINE void copy(const Ends& from, std::size_t count) {
      std::copy_n(from.places, 2 * count, places);
      std::copy_n(from.nearness, count, nearness);
      std::copy_n(from.log2_radii, count, log2_radii);
    }
    HWY_ALIGN float places[2 * (room + lanes)]; // column, line
    HWY_ALIGN float nearness[room];
    HWY_ALIGN float log2_radii[room];
  };

  // Projects the cluster's nodes onto the screen.
  HWY_INLINE void project(const pipeline::VesselCluster& cluster, const ClusterView& view,
                          const pipeline::PackedNode* nodes, std::size_t count) {
    const auto row = [](const std::array<float, 4>& r, Real x, Real y, Real z) {
      return hn::MulAdd(x, real(r[0]),
                        hn::MulAdd(y, real(r[1]), hn::MulAdd(z, real(r[2]), real(r[3]))));
    };
    const auto number = [](Word v) { return hn::ConvertTo(Floats{}, hn::BitCast(Ints{}, v)); };
    for (std::size_t i = 0; i < count; i += lanes) {
      for (std::size_t line = 0; line < lanes; line += nodes_a_cache_line)
        __builtin_prefetch(nodes + i + nodes_ahead + line);
      Word low, high;
      if (HWY_LIKELY(i + lanes <= count)) {
        hn::LoadInterleaved2(Words{}, &nodes[i].low, low, high);
      } else {
        HWY_ALIGN pipeline::PackedNode last[lanes] = {};
        std::copy(nodes + i, nodes + count, last);
        hn::LoadInterleaved2(Words{}, &last[0].low, low, high);
      }
      const Real x = number(hn::And(low, word(0x3FFF)));
      const Real y = number(hn::And(hn::ShiftRight<14>(low), word(0x3FFF)));
      const Real z =
          number(hn::Or(hn::ShiftRight<28>(low), hn::ShiftLeft<4>(hn::And(high, word(0x3FF)))));
      const Real log2_radius =
          hn::MulAdd(number(hn::And(hn::ShiftRight<10>(high), word(0x3FF))),
                     real(cluster.log2_radius_step), real(view.log2_smallest()));
      const Real nearness = hn::Div(real(1), row(view.distance(), x, y, z));
      const Real column = hn::Mul(row(view.column(), x, y, z), nearness);
      const Real line = hn::Mul(row(view.line(), x, y, z), nearness);
      // 2^v, at most 6 % too large: the fraction is used linearly as the mantissa. The start of a
      // segment is at most half as wide again (widest_px_per_mm()).
      const Real radius =
          hn::BitCast(Floats{}, hn::ConvertTo(Ints{}, hn::MulAdd(log2_radius, real(8388608.0F),
                                                                 real(127.0F * 8388608.0F))));
      hn::StoreInterleaved2(column, line, Floats{}, ends_.places + 2 * i);
      hn::Store(nearness, Floats{}, ends_.nearness + i);
      hn::Store(log2_radius, Floats{}, ends_.log2_radii + i);
      hn::Store(hn::MulAdd(radius, real(view.widest_px_per_mm()), real(1e-3F)), Floats{},
                reaches_ + i);
      const Word parent = hn::And(hn::ShiftRight<20>(high), word(0xFF));
      hn::Store(parent, Words{}, parents_ + i);
    }
  }

  // Plain loads and stores: gathers are no faster on any processor, and much slower on some.
  HWY_INLINE void find_parents(const pipeline::VesselCluster& cluster) {
    const std::size_t end = cluster.nodes;
    const std::uint32_t* HWY_RESTRICT parents = parents_;
    float* HWY_RESTRICT places = parent_places_;
    const float* HWY_RESTRICT ends = ends_.places;
#pragma GCC unroll 4
    for (std::size_t i = cluster.references; i < end; ++i)
      std::memcpy(places + 2 * i, ends + 2 * std::size_t{parents[i]}, 2 * sizeof(float));
  }

  // Draws fewer segments for the same coverage; see merged_order.h. First copies the drawn nodes
  // and their parents side by side, so that the other nodes cost no time.
  HWY_NOINLINE void splat_merged(const pipeline::VesselCluster& cluster, const ClusterView& view,
                                 const pipeline::PackedNode* nodes, std::size_t taken,
                                 std::size_t thin) {
    // The access is too irregular for hardware prefetching; the next cluster is stored next.
    for (std::size_t i = 0; i < pipeline::largest_cluster; i += nodes_a_cache_line)
      __builtin_prefetch(nodes + cluster.nodes + i);
    drawn_ = 0;
    take_drawn(nodes, taken, {static_cast<std::uint32_t>(thin - taken), 1, 0});
    std::size_t begin = thin;
    for (std::size_t order = least_order_kept_visible; order-- > 0;) {
      const std::size_t end = std::max<std::size_t>(begin, cluster.nodes_from_order[order]);
      if (begin < end)
        take_drawn(nodes, begin,
                   merged_order(view.radius_px(nodes[begin]), frame_.detail_px,
                                static_cast<std::uint32_t>(end - begin)));
      begin = end;
    }
    counts_.merged += cluster.nodes - taken - drawn_;
    project(cluster, view, drawn_parents_, drawn_);
    starts_.copy(ends_, drawn_);
    project(cluster, view, drawn_nodes_, drawn_);
    widen();
    const auto start = [this](std::size_t i) { return starts_.at(i); };
    choose(0, thin - taken, kept_visible_reach, view.inside());
    add_chosen(cluster, drawn_nodes_, start);
    choose(thin - taken, drawn_, 0, view.inside());
    add_chosen(cluster, drawn_nodes_, start);
  }

  HWY_INLINE void take_drawn(const pipeline::PackedNode* nodes, std::size_t begin,
                             const MergedOrder& order) {
    const std::size_t end = drawn_ + order.whole + (order.last_widening > 0 ? 1 : 0);
    for (; drawn_ < end; ++drawn_, ++begin) {
      drawn_nodes_[drawn_] = nodes[begin];
      drawn_parents_[drawn_] = nodes[nodes[begin].parent()];
      widenings_[drawn_] = order.widening;
    }
    if (order.last_widening > 0)
      widenings_[end - 1] = order.last_widening;
  }

  // Widens a segment and shortens it so that its round ends cover no more than those of the
  // segments that it stands for: L′ = L − π/2 · (widening − 1) · r, but at least 0.
  HWY_INLINE void widen() {
    for (std::size_t i = 0; i < drawn_; i += lanes) {
      Real ax, ay, bx, by;
      hn::LoadInterleaved2(Floats{}, starts_.places + 2 * i, ax, ay);
      hn::LoadInterleaved2(Floats{}, ends_.places + 2 * i, bx, by);
      Real la = hn::Load(Floats{}, starts_.log2_radii + i);
      Real lb = hn::Load(Floats{}, ends_.log2_radii + i);
      const Real widening = hn::Load(Floats{}, widenings_ + i);
      const Real log2_widening = hn::Log2(Floats{}, widening);
      la = hn::Add(hn::Min(la, hn::Add(lb, real(log2_widest_start))), log2_widening);
      lb = hn::Add(lb, log2_widening);
      // The reach belongs to the start, which is half as wide again.
      const Real reach = hn::Load(Floats{}, reaches_ + i);
      const Real by_px = hn::Mul(hn::Sub(widening, real(1)),
                                 hn::Mul(reach, real(0.7854F / pipeline::widest_start)));
      const Real dx = hn::Sub(bx, ax);
      const Real dy = hn::Sub(by, ay);
      const Real length2 = hn::Max(hn::MulAdd(dx, dx, hn::Mul(dy, dy)), real(1e-12F));
      const Real share =
          hn::Max(hn::Min(hn::Div(by_px, hn::Sqrt(length2)), real(0.5F)), real(-0.5F));
      ax = hn::MulAdd(share, dx, ax);
      ay = hn::MulAdd(share, dy, ay);
      bx = hn::NegMulAdd(share, dx, bx);
      by = hn::NegMulAdd(share, dy, by);
      hn::StoreInterleaved2(ax, ay, Floats{}, starts_.places + 2 * i);
      hn::StoreInterleaved2(ax, ay, Floats{}, parent_places_ + 2 * i);
      hn::StoreInterleaved2(bx, by, Floats{}, ends_.places + 2 * i);
      hn::Store(la, Floats{}, starts_.log2_radii + i);
      hn::Store(lb, Floats{}, ends_.log2_radii + i);
      hn::Store(hn::Mul(reach, widening), Floats{}, reaches_ + i);
    }
  }

  template <class Start>
  HWY_INLINE void add_chosen(const pipeline::VesselCluster& cluster,
                             const pipeline::PackedNode* nodes, const Start& start) {
    const BaseColour* colours = frame_.colours[static_cast<std::size_t>(cluster.branch)].data();
    for (std::size_t kind = 0; kind < kinds; ++kind)
      if (HWY_UNLIKELY(queues_[kind].space() < chosen_))
        queues_[kind].draw_full(kind == one_centre);
    const std::uint32_t* HWY_RESTRICT choice = choice_;
    for (std::size_t k = 0; k < chosen_; ++k) {
      const std::uint32_t i = choice[k] & ((1U << kind_shift) - 1);
      queues_[choice[k] >> kind_shift].add(start(i), ends_.at(i), colours[nodes[i].order()]);
    }
  }

  HWY_INLINE End start_of(std::size_t i) const {
    End start = ends_.at(parents_[i]);
    start.log2_radius = std::min(start.log2_radius, ends_.log2_radii[i] + log2_widest_start);
    return start;
  }

  // Selects, among the segments that end at nodes [begin, end), those that may cover a pixel
  // centre. `inside`: all are in the picture.
  HWY_INLINE void choose(std::size_t begin, std::size_t end, float least_reach, bool inside) {
    const Real right = real(static_cast<float>(frame_.width) - 0.5F);
    const Real bottom = real(static_cast<float>(frame_.height) - 0.5F);
    const Real edge = real(-0.5F);
    std::size_t in_picture = 0;
    std::size_t chosen = 0;
    for (std::size_t i = begin; i < end; i += lanes) {
      const Real reach = hn::Max(hn::LoadU(Floats{}, reaches_ + i), real(least_reach));
      Real ax, ay, bx, by;
      hn::LoadInterleaved2(Floats{}, parent_places_ + 2 * i, ax, ay);
      hn::LoadInterleaved2(Floats{}, ends_.places + 2 * i, bx, by);
      const Real left_x = hn::Sub(hn::Min(ax, bx), reach);
      const Real right_x = hn::Add(hn::Max(ax, bx), reach);
      const Real top_y = hn::Sub(hn::Min(ay, by), reach);
      const Real bottom_y = hn::Add(hn::Max(ay, by), reach);
      Mask seen = hn::FirstN(Floats{}, end - i);
      if (!inside) {
        const Mask meets = hn::And(hn::And(hn::Ge(right_x, edge), hn::Le(left_x, right)),
                                   hn::And(hn::Ge(bottom_y, edge), hn::Le(top_y, bottom)));
        seen = hn::And(seen, meets);
      }
      in_picture += hn::CountTrue(Floats{}, seen);
      // The rectangle's last pixel centre, and how far its first sides are from there.
      const Real x = hn::Floor(right_x);
      const Real y = hn::Floor(bottom_y);
      const Real wide = hn::Sub(x, left_x);
      const Real high = hn::Sub(y, top_y);
      const Real longer = hn::Max(wide, high);
      const Mask has_centre = hn::Ge(hn::Min(wide, high), real(0));
      const Mask has_more = hn::Ge(longer, real(1));
      // No further than `reach` from the line through the ends.
      const Real dx = hn::Sub(bx, ax);
      const Real dy = hn::Sub(by, ay);
      const Real across = hn::MulSub(dx, hn::Sub(y, ay), hn::Mul(dy, hn::Sub(x, ax)));
      const Real limit = hn::Mul(hn::Mul(reach, reach), hn::MulAdd(dx, dx, hn::Mul(dy, dy)));
      const Mask close = hn::Or(has_more, hn::Le(hn::Mul(across, across), limit));
      const Mask hit = hn::And(hn::And(seen, has_centre), close);
      const Mask has_many = hn::Ge(longer, real(most_few_px));
      const auto if_so = [](Mask mask, Kind kind) {
        return hn::IfThenElseZero(hn::RebindMask(Words{}, mask), word(kind << kind_shift));
      };
      const Word kind = hn::Add(if_so(has_more, few_centres), if_so(has_many, few_centres));
      const Word index = hn::Iota(Words{}, static_cast<std::uint32_t>(i));
      store_lanes(Words{}, hn::Or(index, kind), hn::RebindMask(Words{}, hit), choice_ + chosen);
      chosen += hn::CountTrue(Floats{}, hit);
    }
    chosen_ = chosen;
    counts_.splatted += in_picture;
    counts_.culled += end - begin - in_picture;
  }

  // Draws segments that may be partly nearer than the near distance, one by one.
  HWY_NOINLINE void splat_clipped(const pipeline::VesselCluster& cluster, const ClusterView& view,
                                  const pipeline::PackedNode* nodes, std::size_t taken) {
    const BaseColour* colours = frame_.colours[static_cast<std::size_t>(cluster.branch)].data();
    for (std::size_t i = taken; i < cluster.nodes; ++i) {
      const auto clipped =
          clip_to_near(frame_, view.place(nodes[nodes[i].parent()]), view.place(nodes[i]));
      if (!clipped) {
        ++counts_.culled;
        continue;
      }
      ++counts_.splatted;
      ShapeQueue& queue = queues_[more_centres];
      if (queue.space() < 1)
        queue.draw_full(false);
      const auto end = [](const ScreenPlace& p) {
        return End{p.column, p.line, p.nearness, p.log2_radius};
      };
      queue.add(end(clipped->start), end(clipped->end), colours[nodes[i].order()]);
    }
  }

  const SplatFrame& frame_;
  SplatCounts counts_;
  Fragments fragments_;
  ShapeQueue queues_[kinds];
  std::size_t chosen_ = 0;
  HWY_ALIGN std::uint32_t choice_[room + lanes]; // indices and kinds
  Ends ends_;
  HWY_ALIGN float reaches_[room + lanes]; // bounds of a segment's half-width
  HWY_ALIGN float parent_places_[2 * (room + lanes)];
  HWY_ALIGN std::uint32_t parents_[room];
  // The drawn segments of a cluster of which some are merged.
  std::size_t drawn_ = 0;
  HWY_ALIGN pipeline::PackedNode drawn_nodes_[room];
  HWY_ALIGN pipeline::PackedNode drawn_parents_[room];
  HWY_ALIGN float widenings_[room];
  Ends starts_;
};

SplatCounts splat_clusters(const SplatFrame& frame, std::uint32_t first, std::uint32_t end) {
  ClusterSplatter splatter{frame};
  for (std::uint32_t i = first; i < end; ++i)
    splatter.splat(i);
  return splatter.finish();
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace splat

const SplatKernels* splat_kernels_of_target() {
  static const SplatKernels table{hwy::TargetName(HWY_TARGET), &splat::splat_clusters,
                                  &splat::smooth_rows};
  return &table;
}

// NOLINTNEXTLINE(google-readability-namespace-comments)
} // namespace octascope::ui::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif // HWY_SCALAR

#endif
