// Method 1: every vessel a tube of triangles, expanded by GL or by the processor.
#pragma once

#include <memory>
#include <vector>

#include "ui/vessels/scene/cluster_culling.h"
#include "ui/vessels/scene/ordered_batches.h"
#include "ui/vessels/scene/vessel_method.h"
#include "ui/vessels/tubes/tube_node_painter.h"
#include "ui/vessels/tubes/tube_stream_painter.h"
#include "ui/vessels/tubes/vessel_ends.h"
#include "ui/view/segment_counts.h"

namespace octascope::ui {

// A frame's clusters, divided by whether their half balls are visible.
class TubeClusters {
public:
  // Returns the number of culled segments. Allocates for a new tree only.
  std::uint64_t place(const VesselScene& scene, const VesselFrame& frame, ClusterChoice choice);
  std::span<const PlacedCluster> get(bool caps) const { return placed_[caps ? 1 : 0]; }

private:
  std::vector<ClusterPart> parts_;
  std::array<std::vector<PlacedCluster>, 2> placed_;
};

// Threads: as gl/objects.h.
class TubesMethod final : public VesselMethod {
public:
  // ErrorCode::unsupported: this GL cannot compile our shaders.
  static hal::Result<std::unique_ptr<TubesMethod>>
  create(std::shared_ptr<NodeTexture> nodes, ClusterChoice choice, const TubeShape& shape = {});

private:
  TubesMethod(TubeNodePainter painter, ClusterChoice choice)
      : painter_{std::move(painter)}, choice_{choice} {}
  hal::Result<SegmentCounts> do_draw(const VesselScene& scene) override;

  TubeNodePainter painter_;
  ClusterChoice choice_;
  TubeClusters clusters_;
};

// Expands on two threads, one of which also feeds GL.
//
// Threads: as gl/objects.h, but for its own helper.
class StreamedTubesMethod final : public VesselMethod {
public:
  // `threads` is called on the helper. ErrorCode::unsupported: this GL cannot compile our shaders.
  static hal::Result<std::unique_ptr<StreamedTubesMethod>>
  create(ClusterChoice choice, const pipeline::ThreadSetup& threads, const TubeShape& shape = {});

private:
  StreamedTubesMethod(TubeStreamPainter painter, ClusterChoice choice,
                      const pipeline::ThreadSetup& threads);
  hal::Result<SegmentCounts> do_draw(const VesselScene& scene) override;
  hal::Result<> draw_clusters(std::span<const PlacedCluster> clusters, bool caps,
                              const VesselScene& scene, const VesselFrame& frame);

  TubeStreamPainter painter_;
  ClusterChoice choice_;
  TubeClusters clusters_;
  TreeEnds ends_;
  OrderedBatches order_; // last: its thread stops before the other members are destroyed
};

} // namespace octascope::ui
