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
      : frame_{frame}, dots_{frame}, lines_of_pixels_{frame} {}

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
    choose(taken, thin, kept_visible_reach);
    add_chosen(cluster, nodes, start);
    choose(thin, cluster.nodes, 0);
    add_chosen(cluster, nodes, start);
  }

  SplatCounts finish() {
    dots_.queue.finish();
    lines_of_pixels_.queue.finish();
    return counts_;
  }

private:
  static constexpr std::size_t room = 256 + lanes;
  static constexpr std::size_t nodes_a_cache_line = 8;
  static constexpr float kept_visible_reach = least_vessel_radius_px + 1e-3F;

  // The cluster's segments to be drawn, and the queue that they go to.
  struct Choice {
    explicit Choice(const SplatFrame& frame) : queue{frame} {}

    HWY_INLINE void note(Word index, Mask chosen) {
      store_lanes(Words{}, index, hn::RebindMask(Words{}, chosen), indices + count);
      count += hn::CountTrue(Floats{}, chosen);
    }
    template <class Add> HWY_INLINE void take(const Add& add) {
      if (HWY_UNLIKELY(queue.space() < count))
        queue.draw_full();
      const std::uint32_t* HWY_RESTRICT chosen = indices;
      for (std::size_t k = 0; k < count; ++k)
        add(chosen[k]);
      count = 0;
    }

    ShapeQueue queue;
    std::size_t count = 0;
    HWY_ALIGN std::uint32_t indices[room + lanes];
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
      hn::Store(column, Floats{}, columns_ + i);
      hn::Store(line, Floats{}, lines_ + i);
      hn::Store(hn::MulAdd(radius, real(view.widest_px_per_mm()), real(1e-3F)), Floats{},
                reaches_ + i);
      hn::StoreInterleaved4(column, line, nearness, log2_radius, Floats{}, &ends_[i].column);
      const Word parent = hn::And(hn::ShiftRight<20>(high), word(0xFF));
      hn::Store(parent, Words{}, parents_ + i);
    }
  }

  // Plain loads and stores: gathers are no faster on any processor, and much slower on some.
  HWY_INLINE void find_parents(const pipeline::VesselCluster& cluster) {
    const std::size_t end = cluster.nodes;
    const std::uint32_t* HWY_RESTRICT parents = parents_;
    float* HWY_RESTRICT places = parent_places_;
    const End* HWY_RESTRICT ends = ends_;
    for (std::size_t i = cluster.references; i < end; ++i)
      std::memcpy(places + 2 * i, ends + parents[i], 2 * sizeof(float));
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
    std::copy_n(ends_, drawn_, starts_);
    project(cluster, view, drawn_nodes_, drawn_);
    widen();
    const auto start = [this](std::size_t i) { return starts_[i]; };
    choose(0, thin - taken, kept_visible_reach);
    add_chosen(cluster, drawn_nodes_, start);
    choose(thin - taken, drawn_, 0);
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
      Real ax, ay, wa, la, bx, by, wb, lb;
      hn::LoadInterleaved4(Floats{}, &starts_[i].column, ax, ay, wa, la);
      hn::LoadInterleaved4(Floats{}, &ends_[i].column, bx, by, wb, lb);
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
      hn::StoreInterleaved4(ax, ay, wa, la, Floats{}, &starts_[i].column);
      hn::StoreInterleaved4(bx, by, wb, lb, Floats{}, &ends_[i].column);
      hn::StoreInterleaved2(ax, ay, Floats{}, parent_places_ + 2 * i);
      hn::Store(bx, Floats{}, columns_ + i);
      hn::Store(by, Floats{}, lines_ + i);
      hn::Store(hn::Mul(reach, widening), Floats{}, reaches_ + i);
    }
  }

  template <class Start>
  HWY_INLINE void add_chosen(const pipeline::VesselCluster& cluster,
                             const pipeline::PackedNode* nodes, const Start& start) {
    const BaseColour* colours = frame_.colours[static_cast<std::size_t>(cluster.branch)].data();
    for (Choice* choice : {&dots_, &lines_of_pixels_})
      choice->take([&](std::uint32_t i) {
        choice->queue.add(start(i), ends_[i], colours[nodes[i].order()]);
      });
  }

  HWY_INLINE End start_of(std::size_t i) const {
    End start = ends_[parents_[i]];
    start.log2_radius = std::min(start.log2_radius, ends_[i].log2_radius + log2_widest_start);
    return start;
  }

  // Selects, among the segments that end at nodes [begin, end), those that may cover a pixel
  // centre.
  HWY_INLINE void choose(std::size_t begin, std::size_t end, float least_reach) {
    const Real right = real(static_cast<float>(frame_.width) - 0.5F);
    const Real bottom = real(static_cast<float>(frame_.height) - 0.5F);
    const Real edge = real(-0.5F);
    std::size_t in_picture = 0;
    for (std::size_t i = begin; i < end; i += lanes) {
      const Real bx = hn::LoadU(Floats{}, columns_ + i);
      const Real by = hn::LoadU(Floats{}, lines_ + i);
      const Real reach = hn::Max(hn::LoadU(Floats{}, reaches_ + i), real(least_reach));
      Real ax, ay;
      hn::LoadInterleaved2(Floats{}, parent_places_ + 2 * i, ax, ay);
      const Real left_x = hn::Sub(hn::Min(ax, bx), reach);
      const Real right_x = hn::Add(hn::Max(ax, bx), reach);
      const Real top_y = hn::Sub(hn::Min(ay, by), reach);
      const Real bottom_y = hn::Add(hn::Max(ay, by), reach);
      const Mask inside = hn::And(hn::And(hn::Ge(right_x, edge), hn::Le(left_x, right)),
                                  hn::And(hn::Ge(bottom_y, edge), hn::Le(top_y, bottom)));
      const Mask seen = hn::And(hn::FirstN(Floats{}, end - i), inside);
      in_picture += hn::CountTrue(Floats{}, seen);
      // The rectangle's last pixel centre, and whether it is the only one.
      const Real x = hn::Floor(right_x);
      const Real y = hn::Floor(bottom_y);
      const Mask has_centre = hn::And(hn::Ge(x, left_x), hn::Ge(y, top_y));
      const Mask has_more =
          hn::Or(hn::Ge(hn::Sub(x, real(1)), left_x), hn::Ge(hn::Sub(y, real(1)), top_y));
      // No further than `reach` from the line through the ends.
      const Real dx = hn::Sub(bx, ax);
      const Real dy = hn::Sub(by, ay);
      const Real across = hn::MulSub(dx, hn::Sub(y, ay), hn::Mul(dy, hn::Sub(x, ax)));
      const Real limit = hn::Mul(hn::Mul(reach, reach), hn::MulAdd(dx, dx, hn::Mul(dy, dy)));
      const Mask close = hn::Or(has_more, hn::Le(hn::Mul(across, across), limit));
      const Mask hit = hn::And(hn::And(seen, has_centre), close);
      const Word index = hn::Iota(Words{}, static_cast<std::uint32_t>(i));
      dots_.note(index, hn::AndNot(has_more, hit));
      lines_of_pixels_.note(index, hn::And(has_more, hit));
    }
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
      ShapeQueue& queue = lines_of_pixels_.queue;
      if (queue.space() < 1)
        queue.draw_full();
      const auto end = [](const ScreenPlace& p) {
        return End{p.column, p.line, p.nearness, p.log2_radius};
      };
      queue.add(end(clipped->start), end(clipped->end), colours[nodes[i].order()]);
    }
  }

  const SplatFrame& frame_;
  SplatCounts counts_;
  // Segments with a single candidate pixel are drawn together, because lanes wait for the slowest.
  Choice dots_;
  Choice lines_of_pixels_;
  HWY_ALIGN End ends_[room];
  HWY_ALIGN float columns_[room + lanes];
  HWY_ALIGN float lines_[room + lanes];
  HWY_ALIGN float reaches_[room + lanes]; // bounds of a segment's half-width
  HWY_ALIGN float parent_places_[2 * (room + lanes)];
  HWY_ALIGN std::uint32_t parents_[room];
  // The drawn segments of a cluster of which some are merged.
  std::size_t drawn_ = 0;
  HWY_ALIGN pipeline::PackedNode drawn_nodes_[room];
  HWY_ALIGN pipeline::PackedNode drawn_parents_[room];
  HWY_ALIGN float widenings_[room];
  HWY_ALIGN End starts_[room];
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
