#include "ui/vessels/hybrid/quads_share.h"

#include <utility>

#include "ui/vessels/scene/vessel_uniforms.h"

namespace octascope::ui {

hal::Result<std::unique_ptr<QuadsShare>> QuadsShare::create(std::shared_ptr<NodeTexture> nodes) {
  HAL_TRY(auto painter, QuadNodePainter::create(std::move(nodes)));
  return std::unique_ptr<QuadsShare>{new QuadsShare{std::move(painter)}};
}

hal::Result<SegmentCounts> QuadsShare::do_draw(const VesselScene& scene, const VesselSplit& split) {
  const auto& clusters = scene.tree.clusters;
  const VesselFrame frame = make_vessel_frame(scene);
  HAL_CHECK(painter_.begin(frame, scene.tree));
  parts_.clear();
  parts_.reserve(clusters.size());
  choose_clusters(frame, scene.tree, ClusterChoice::visible, parts_);
  for (auto& placed : placed_) {
    placed.clear();
    placed.reserve(clusters.size());
  }
  const auto given = [&](std::size_t i) {
    return static_cast<std::uint32_t>(split[i] - clusters[i].references);
  };
  SegmentCounts account;
  for (std::size_t i = 0; i < clusters.size(); ++i)
    account.culled += given(i);
  for (const ClusterPart& part : parts_) {
    const std::uint32_t segments = given(part.cluster);
    if (segments == 0)
      continue;
    placed_[static_cast<std::size_t>(quad_kind(part.largest_radius_px))].push_back(
        place_cluster(frame, clusters[part.cluster], segments));
    account.drawn += segments;
  }
  account.culled -= account.drawn;
  const VesselDrawState state;
  for (std::size_t kind = 0; kind < quad_kind_count; ++kind)
    painter_.draw(placed_[kind], static_cast<QuadKind>(kind));
  return account;
}

} // namespace octascope::ui
