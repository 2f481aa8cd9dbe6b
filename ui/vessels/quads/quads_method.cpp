#include "ui/vessels/quads/quads_method.h"

#include "ui/vessels/scene/vessel_uniforms.h"

namespace octascope::ui {

hal::Result<std::unique_ptr<QuadsMethod>> QuadsMethod::create(std::shared_ptr<NodeTexture> nodes,
                                                              ClusterChoice choice) {
  HAL_TRY(auto painter, QuadNodePainter::create(std::move(nodes)));
  return std::unique_ptr<QuadsMethod>{new QuadsMethod{std::move(painter), choice}};
}

hal::Result<SegmentCounts> QuadsMethod::do_draw(const VesselScene& scene) {
  const VesselFrame frame = make_vessel_frame(scene);
  HAL_CHECK(painter_.begin(frame, scene.tree));
  parts_.clear();
  parts_.reserve(scene.tree.clusters.size());
  SegmentCounts account;
  account.culled = choose_clusters(frame, scene.tree, choice_, parts_);
  account.drawn = scene.tree.segments - account.culled;
  for (auto& placed : placed_) {
    placed.clear();
    placed.reserve(scene.tree.clusters.size());
  }
  for (const ClusterPart& part : parts_)
    placed_[static_cast<std::size_t>(quad_kind(part.largest_radius_px))].push_back(
        place_cluster(frame, scene.tree.clusters[part.cluster], part.segments));
  const VesselDrawState state;
  for (std::size_t kind = 0; kind < quad_kind_count; ++kind)
    painter_.draw(placed_[kind], static_cast<QuadKind>(kind));
  return account;
}

} // namespace octascope::ui
