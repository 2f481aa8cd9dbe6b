// Segments as quads, expanded by GL from the tree's packed nodes.
#pragma once

#include <memory>
#include <span>

#include "ui/gl/objects.h"
#include "ui/vessels/quads/quad_programs.h"
#include "ui/vessels/scene/node_texture.h"

namespace octascope::ui {

// One instance per cluster: its record is the instance's attributes, because GLES has no base
// instance and does not guarantee storage buffers in the vertex stage.
//
// Threads: as gl/objects.h. Allocates in create() only.
class QuadNodePainter {
public:
  // `nodes` is shared by all painters of the same tree. ErrorCode::unsupported: this GL cannot
  // compile the shaders.
  static hal::Result<QuadNodePainter> create(std::shared_ptr<NodeTexture> nodes);

  // Prepares draw() for clusters of that tree in that frame.
  hal::Result<> begin(const VesselFrame& frame, const pipeline::VesselClusters& tree);
  // All clusters must be of that kind. Returns when GL has copied the records.
  void draw(std::span<const PlacedCluster> clusters, QuadKind kind) const;

private:
  QuadNodePainter(QuadPrograms programs, std::shared_ptr<NodeTexture> nodes);

  QuadPrograms programs_;
  std::shared_ptr<NodeTexture> nodes_;
  gl::Buffer instances_;
  std::array<gl::Buffer, quad_kind_count> indices_;
  std::array<gl::VertexArray, quad_kind_count> vertex_arrays_;
};

// Sets up PlacedCluster records in the bound vertex array and GL_ARRAY_BUFFER as instance
// attributes 0 to 4 (shaders/vessels/vessel_nodes.glsl).
void describe_placed_clusters();

} // namespace octascope::ui
