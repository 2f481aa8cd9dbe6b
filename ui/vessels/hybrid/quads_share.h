// GL's share of a vessel tree as quads, expanded from the packed nodes.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "ui/vessels/hybrid/gl_share.h"
#include "ui/vessels/quads/quad_node_painter.h"
#include "ui/vessels/scene/cluster_culling.h"
#include "ui/view/segment_counts.h"

namespace octascope::ui {

// Threads: as gl/objects.h.
class QuadsShare final : public GlShare {
public:
  // ErrorCode::unsupported: this GL cannot compile the shaders.
  static hal::Result<std::unique_ptr<QuadsShare>> create(std::shared_ptr<NodeTexture> nodes);

private:
  explicit QuadsShare(QuadNodePainter painter) : painter_{std::move(painter)} {}
  hal::Result<SegmentCounts> do_draw(const VesselScene& scene, const VesselSplit& split) override;

  QuadNodePainter painter_;
  std::vector<ClusterPart> parts_;
  std::array<std::vector<PlacedCluster>, quad_kind_count> placed_;
};

} // namespace octascope::ui
