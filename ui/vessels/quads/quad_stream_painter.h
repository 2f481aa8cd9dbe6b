// Segments as quads, expanded by the processor into GL buffers.
#pragma once

#include "ui/vessels/quads/quad_expander.h"
#include "ui/vessels/scene/stream_slots.h"

namespace octascope::ui {

// Threads: as gl/objects.h, except for expand(). Allocates in create() only.
class QuadStreamPainter {
public:
  static constexpr std::uint32_t batch_clusters = 16; // most_quads can hold all their segments

  // ErrorCode::unsupported: this GL cannot compile the shaders.
  static hal::Result<QuadStreamPainter> create(std::uint32_t slots);

  // Prepares slots for expand(). ErrorCode::system: the driver has no memory.
  hal::Result<> begin(const VesselFrame& frame);
  // Any thread, one per slot; at most batch_clusters, all of the same kind.
  void expand(std::uint32_t slot, const VesselFrame& frame, std::span<const PlacedCluster> clusters,
              std::span<const pipeline::PackedNode> nodes);
  // Draws what was expanded, and prepares the slot for the next batch.
  hal::Result<> draw(std::uint32_t slot, QuadKind kind);

private:
  QuadStreamPainter(QuadPrograms programs, std::uint32_t slots);

  QuadPrograms programs_;
  StreamSlots slots_;
  std::vector<std::uint32_t> segments_; // per slot
  std::vector<gl::VertexArray> vertex_arrays_;
  std::array<gl::Buffer, quad_kind_count> indices_;
};

} // namespace octascope::ui
