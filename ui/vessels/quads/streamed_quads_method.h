// Method 2 with the processor: it expands the quads and GL draws them, or both expand their part.
#pragma once

#include <optional>

#include "ui/vessels/quads/quad_node_painter.h"
#include "ui/vessels/quads/quad_stream_painter.h"
#include "ui/vessels/scene/cluster_culling.h"
#include "ui/vessels/scene/gpu_pace.h"
#include "ui/vessels/scene/ordered_batches.h"
#include "ui/vessels/scene/vessel_method.h"
#include "ui/view/segment_counts.h"

namespace octascope::ui {

// How many of the last drawn segments each side expanded.
struct VesselShares {
  std::uint64_t of_gl = 0;
  std::uint64_t of_processor = 0;
};

// The picture equals QuadsMethod's pixel for pixel if GL rounds every step of the shaders
// (segment_projection.h), except for the diagnostic colours.
//
// Threads: as gl/objects.h, but for its own helper.
class StreamedQuadsMethod final : public VesselMethod {
public:
  // Without `nodes`, the processor expands everything on two threads, one of which also feeds GL.
  // With them, GL takes batches from the same cursor as the helper: balanced. `threads` is called
  // on the helper. ErrorCode::unsupported: this GL cannot compile our shaders.
  static hal::Result<std::unique_ptr<StreamedQuadsMethod>>
  create(std::shared_ptr<NodeTexture> nodes, ClusterChoice choice,
         const pipeline::ThreadSetup& threads);

  const VesselShares& shares() const { return shares_; }

private:
  struct Batch {
    QuadKind kind;
    std::uint32_t first; // in placed_[kind]
    std::uint32_t clusters;
    std::uint32_t segments;
  };

  StreamedQuadsMethod(std::optional<QuadNodePainter> gl, QuadStreamPainter processor,
                      ClusterChoice choice, const pipeline::ThreadSetup& threads);
  hal::Result<SegmentCounts> do_draw(const VesselScene& scene) override;
  std::uint64_t prepare(const VesselScene& scene, const VesselFrame& frame); // returns the number
                                                                             // culled
  void add_batches(QuadKind kind);
  std::span<const PlacedCluster> clusters_of(const Batch& batch) const;
  hal::Result<> draw_batches(std::span<const Batch> batches, const VesselScene& scene,
                             const VesselFrame& frame);

  std::optional<QuadNodePainter> gl_;
  QuadStreamPainter processor_;
  ClusterChoice choice_;
  GpuPace pace_;
  std::vector<ClusterPart> parts_;
  std::array<std::vector<PlacedCluster>, quad_kind_count> placed_;
  std::vector<Batch> batches_;
  VesselShares shares_;
  OrderedBatches order_; // last: its thread stops before the other members are destroyed
};

} // namespace octascope::ui
