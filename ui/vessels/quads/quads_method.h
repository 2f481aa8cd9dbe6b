// Method 2 by GL alone: every vessel as a quad that faces the eye, expanded from the packed nodes.
#pragma once

#include <vector>

#include "ui/vessels/quads/quad_node_painter.h"
#include "ui/vessels/scene/cluster_culling.h"
#include "ui/vessels/scene/vessel_method.h"
#include "ui/view/segment_counts.h"

namespace octascope::ui {

// Threads: as gl/objects.h.
class QuadsMethod final : public VesselMethod {
public:
  // ErrorCode::unsupported: this GL cannot compile the shaders.
  static hal::Result<std::unique_ptr<QuadsMethod>> create(std::shared_ptr<NodeTexture> nodes,
                                                          ClusterChoice choice);

private:
  QuadsMethod(QuadNodePainter painter, ClusterChoice choice)
      : painter_{std::move(painter)}, choice_{choice} {}
  hal::Result<SegmentCounts> do_draw(const VesselScene& scene) override;

  QuadNodePainter painter_;
  ClusterChoice choice_;
  std::vector<ClusterPart> parts_;
  std::array<std::vector<PlacedCluster>, quad_kind_count> placed_;
};

} // namespace octascope::ui
