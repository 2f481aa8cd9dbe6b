// Segments as quads, expanded by the processor into buffers of GL.
#pragma once

#include "ui/vessels/quads/quad_expander.h"
#include "ui/vessels/scene/stream_slots.h"

namespace octascope::ui {

// Threads: as gl/objects.h, but for expand(). Allocates in create() only.
class QuadStreamPainter {
public:
  static constexpr std::uint32_t batch_clusters = 16; // so that most_quads hold all their segments

  // ErrorCode::unsupported: this GL cannot compile our shaders.
  static hal::Result<QuadStreamPainter> create(std::uint32_t slots);

  // Afterwards slots may be expanded into. ErrorCode::system: the driver has no memory.
  hal::Result<> begin(const VesselFrame& frame);
  // Any thread, one per slot; at most batch_clusters, all of that kind.
  void expand(std::uint32_t slot, const VesselFrame& frame, std::span<const PlacedCluster> clusters,
              std::span<const pipeline::PackedNode> nodes, QuadKind kind);
  // Draws what was expanded, and frees the slot.
  hal::Result<> draw(std::uint32_t slot, QuadKind kind);

private:
  QuadStreamPainter(QuadPrograms programs, std::uint32_t slots);

  QuadPrograms programs_;
  StreamSlots slots_;
  std::vector<std::uint32_t> segments_; // by slot
  std::vector<gl::VertexArray> vertex_arrays_;
  std::array<gl::Buffer, quad_kind_count> indices_;
};

} // namespace octascope::ui
