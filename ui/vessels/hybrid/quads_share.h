// GL's part of a vessel tree as quads, expanded from the packed nodes.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "ui/vessels/cluster_culling.h"
#include "ui/vessels/hybrid/gl_share.h"
#include "ui/vessels/quad_node_painter.h"

namespace octascope::ui {

// Threads: as gl/objects.h.
class QuadsShare final : public GlShare {
public:
  // Fault::unsupported: this GL cannot compile our shaders.
  static hal::Result<std::unique_ptr<QuadsShare>> create(std::shared_ptr<NodeTexture> nodes);

private:
  explicit QuadsShare(QuadNodePainter painter) : painter_{std::move(painter)} {}
  hal::Result<VesselAccount> do_draw(const VesselScene& scene, const VesselSplit& split) override;

  QuadNodePainter painter_;
  std::vector<ClusterPart> parts_;
  std::array<std::vector<PlacedCluster>, quad_kind_count> placed_;
};

} // namespace octascope::ui
