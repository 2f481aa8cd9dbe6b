// Segments as tubes, expanded by the processor into buffers of GL.
#pragma once

#include <span>
#include <vector>

#include "ui/vessels/scene/stream_slots.h"
#include "ui/vessels/tubes/tube_expander.h"

namespace octascope::ui {

// Threads: as gl/objects.h, but for expand(). Allocates in create() only.
class TubeStreamPainter {
public:
  // ErrorCode::unsupported: this GL cannot compile our shaders.
  static hal::Result<TubeStreamPainter> create(std::uint32_t slots, const TubeShape& shape);

  std::uint32_t batch_clusters() const { return batch_clusters_; }

  // Afterwards slots may be expanded into. ErrorCode::system: the driver has no memory.
  hal::Result<> begin(const VesselFrame& frame);
  // Any thread, one per slot; at most batch_clusters(). `passed` are the tree's passed_nodes().
  void expand(std::uint32_t slot, const VesselFrame& frame, std::span<const PlacedCluster> clusters,
              std::span<const pipeline::PackedNode> nodes, std::span<const std::uint32_t> passed,
              bool caps);
  // Draws what was expanded, and frees the slot.
  hal::Result<> draw(std::uint32_t slot);

private:
  struct Part {                                 // bodies, or half balls
    std::vector<gl::VertexArray> vertex_arrays; // by slot
    gl::Buffer indices;
    int corners = 0; // of one
  };

  TubeStreamPainter(gl::Program program, std::uint32_t slots, const TubeShape& shape);
  Part make_part(const std::vector<std::uint32_t>& indices, int corners, std::size_t first) const;
  static void draw(const Part& part, std::uint32_t slot, std::uint32_t count);

  gl::Program program_;
  TubeExpander expander_;
  std::uint32_t batch_clusters_;
  std::size_t caps_at_; // in a slot, after the bodies: vertices
  StreamSlots slots_;
  std::vector<TubeExpander::Counts> counts_; // by slot
  Part bodies_;
  Part caps_;
};

} // namespace octascope::ui
