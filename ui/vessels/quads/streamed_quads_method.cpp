#include "ui/vessels/quads/streamed_quads_method.h"

#include <algorithm>

#include "ui/vessels/scene/vessel_uniforms.h"

namespace octascope::ui {

namespace {
constexpr std::uint32_t helper_slots = 4;
constexpr std::uint32_t own_slot = helper_slots; // of the thread that draws
} // namespace

hal::Result<std::unique_ptr<StreamedQuadsMethod>>
StreamedQuadsMethod::create(std::shared_ptr<NodeTexture> nodes, ClusterChoice choice,
                            const pipeline::ThreadSetup& threads) {
  std::optional<QuadNodePainter> gl;
  if (nodes) {
    HAL_TRY(auto made, QuadNodePainter::create(std::move(nodes)));
    gl = std::move(made);
  }
  HAL_TRY(auto processor, QuadStreamPainter::create(helper_slots + 1));
  return std::unique_ptr<StreamedQuadsMethod>{
      new StreamedQuadsMethod{std::move(gl), std::move(processor), choice, threads}};
}

StreamedQuadsMethod::StreamedQuadsMethod(std::optional<QuadNodePainter> gl,
                                         QuadStreamPainter processor, ClusterChoice choice,
                                         const pipeline::ThreadSetup& threads)
    : gl_{std::move(gl)}, processor_{std::move(processor)}, choice_{choice}, order_{helper_slots,
                                                                                    threads} {}

void StreamedQuadsMethod::add_batches(QuadKind kind) {
  const auto& placed = placed_[static_cast<std::size_t>(kind)];
  const auto count = static_cast<std::uint32_t>(placed.size());
  for (std::uint32_t first = 0; first < count; first += QuadStreamPainter::batch_clusters) {
    Batch batch{kind, first, std::min(QuadStreamPainter::batch_clusters, count - first), 0};
    for (const PlacedCluster& cluster : clusters_of(batch))
      batch.segments += cluster.segments;
    batches_.push_back(batch);
  }
}

std::span<const PlacedCluster> StreamedQuadsMethod::clusters_of(const Batch& batch) const {
  return std::span{placed_[static_cast<std::size_t>(batch.kind)]}.subspan(batch.first,
                                                                          batch.clusters);
}

std::uint64_t StreamedQuadsMethod::prepare(const VesselScene& scene, const VesselFrame& frame) {
  const auto& clusters = scene.tree.clusters;
  parts_.clear();
  parts_.reserve(clusters.size());
  const std::uint64_t culled = choose_clusters(frame, scene.tree, choice_, parts_);
  for (auto& placed : placed_) {
    placed.clear();
    placed.reserve(clusters.size());
  }
  for (const ClusterPart& part : parts_)
    placed_[static_cast<std::size_t>(quad_kind(part.largest_radius_px))].push_back(
        place_cluster(frame, clusters[part.cluster], part.segments));
  batches_.clear();
  batches_.reserve(clusters.size() / QuadStreamPainter::batch_clusters + quad_kind_count);
  for (std::size_t kind = 0; kind < quad_kind_count; ++kind)
    add_batches(static_cast<QuadKind>(kind));
  return culled;
}

hal::Result<> StreamedQuadsMethod::draw_batches(std::span<const Batch> batches,
                                                const VesselScene& scene,
                                                const VesselFrame& frame) {
  hal::Result<> drawn;
  const auto expand = [&](std::uint32_t i, std::uint32_t slot) {
    const Batch& batch = batches[i];
    processor_.expand(slot, frame, clusters_of(batch), scene.tree.nodes);
  };
  const auto submit = [&](std::uint32_t i, std::uint32_t slot) {
    if (auto done = processor_.draw(slot, batches[i].kind); !done)
      drawn = done;
    shares_.of_processor += batches[i].segments;
  };
  const auto own = [&](std::uint32_t i) {
    if (gl_) {
      gl_->draw(clusters_of(batches[i]), batches[i].kind);
      pace_.submitted();
      shares_.of_gl += batches[i].segments;
    } else {
      expand(i, own_slot);
      submit(i, own_slot);
    }
  };
  order_.run(static_cast<std::uint32_t>(batches.size()), own, expand, submit);
  return drawn;
}

hal::Result<SegmentCounts> StreamedQuadsMethod::do_draw(const VesselScene& scene) {
  const VesselFrame frame = make_vessel_frame(scene);
  if (gl_)
    HAL_CHECK(gl_->begin(frame, scene.tree));
  HAL_CHECK(processor_.begin(frame));
  const std::uint64_t culled = prepare(scene, frame);
  shares_ = {};
  const VesselDrawState state;
  for (std::span<const Batch> rest{batches_}; !rest.empty();) {
    const std::size_t count = std::min<std::size_t>(rest.size(), OrderedBatches::most_batches);
    HAL_CHECK(draw_batches(rest.first(count), scene, frame));
    rest = rest.subspan(count);
  }
  return SegmentCounts{scene.tree.segments - culled, 0, 0, culled};
}

} // namespace octascope::ui
