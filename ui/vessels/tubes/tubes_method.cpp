#include "ui/vessels/tubes/tubes_method.h"

#include <algorithm>

#include "ui/vessels/scene/vessel_uniforms.h"

namespace octascope::ui {

namespace {
constexpr std::uint32_t helper_slots = 3;
constexpr std::uint32_t own_slot = helper_slots; // of the thread that draws
} // namespace

std::uint64_t TubeClusters::place(const VesselScene& scene, const VesselFrame& frame,
                                  ClusterChoice choice) {
  const auto& clusters = scene.tree.clusters;
  parts_.clear();
  parts_.reserve(clusters.size());
  const std::uint64_t culled = choose_clusters(frame, scene.tree, choice, parts_);
  for (auto& placed : placed_) {
    placed.clear();
    placed.reserve(clusters.size());
  }
  for (const ClusterPart& part : parts_)
    placed_[part.largest_radius_px < smallest_cap_px ? 0 : 1].push_back(
        place_cluster(frame, clusters[part.cluster], part.segments));
  return culled;
}

hal::Result<std::unique_ptr<TubesMethod>> TubesMethod::create(std::shared_ptr<NodeTexture> nodes,
                                                              ClusterChoice choice,
                                                              const TubeShape& shape) {
  HAL_TRY(auto painter, TubeNodePainter::create(std::move(nodes), shape));
  return std::unique_ptr<TubesMethod>{new TubesMethod{std::move(painter), choice}};
}

hal::Result<SegmentCounts> TubesMethod::do_draw(const VesselScene& scene) {
  const VesselFrame frame = make_vessel_frame(scene);
  HAL_CHECK(painter_.begin(frame, scene.tree));
  const std::uint64_t culled = clusters_.place(scene, frame, choice_);
  const VesselDrawState state;
  glEnable(GL_CULL_FACE); // what faces away is hidden behind the rest; the state puts it back
  for (const bool caps : {false, true})
    painter_.draw(clusters_.get(caps), caps);
  return SegmentCounts{scene.tree.segments - culled, 0, 0, culled};
}

hal::Result<std::unique_ptr<StreamedTubesMethod>>
StreamedTubesMethod::create(ClusterChoice choice, const pipeline::ThreadSetup& threads,
                            const TubeShape& shape) {
  HAL_TRY(auto painter, TubeStreamPainter::create(helper_slots + 1, shape));
  return std::unique_ptr<StreamedTubesMethod>{
      new StreamedTubesMethod{std::move(painter), choice, threads}};
}

StreamedTubesMethod::StreamedTubesMethod(TubeStreamPainter painter, ClusterChoice choice,
                                         const pipeline::ThreadSetup& threads)
    : painter_{std::move(painter)}, choice_{choice}, order_{helper_slots, threads} {}

hal::Result<> StreamedTubesMethod::draw_clusters(std::span<const PlacedCluster> clusters, bool caps,
                                                 const VesselScene& scene,
                                                 const VesselFrame& frame) {
  hal::Result<> drawn;
  const std::size_t size = painter_.batch_clusters();
  const auto expand = [&](std::uint32_t batch, std::uint32_t slot) {
    const std::size_t first = batch * size;
    painter_.expand(slot, frame, clusters.subspan(first, std::min(size, clusters.size() - first)),
                    scene.tree.nodes, ends_.passed(), caps);
  };
  const auto submit = [&](std::uint32_t, std::uint32_t slot) {
    if (auto done = painter_.draw(slot); !done)
      drawn = done;
  };
  const auto own = [&](std::uint32_t batch) {
    expand(batch, own_slot);
    submit(batch, own_slot);
  };
  order_.run(static_cast<std::uint32_t>((clusters.size() + size - 1) / size), own, expand, submit);
  return drawn;
}

hal::Result<SegmentCounts> StreamedTubesMethod::do_draw(const VesselScene& scene) {
  const VesselFrame frame = make_vessel_frame(scene);
  HAL_CHECK(painter_.begin(frame));
  ends_.show(scene.tree);
  const std::uint64_t culled = clusters_.place(scene, frame, choice_);
  const std::size_t most = std::size_t{OrderedBatches::most_batches} * painter_.batch_clusters();
  const VesselDrawState state;
  glEnable(GL_CULL_FACE); // what faces away is hidden behind the rest; the state puts it back
  for (const bool caps : {false, true})
    for (auto rest = clusters_.get(caps); !rest.empty();) {
      const std::size_t count = std::min(rest.size(), most);
      HAL_CHECK(draw_clusters(rest.first(count), caps, scene, frame));
      rest = rest.subspan(count);
    }
  return SegmentCounts{scene.tree.segments - culled, 0, 0, culled};
}

} // namespace octascope::ui
