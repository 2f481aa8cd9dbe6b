// Segments as tubes, expanded by GL from the tree's packed nodes.
#pragma once

#include <memory>
#include <span>

#include "ui/gl/objects.h"
#include "ui/vessels/scene/node_texture.h"
#include "ui/vessels/tubes/tube_shape.h"

namespace octascope::ui {

// Threads: as gl/objects.h. Allocates in create(), and in begin() for a new tree.
class TubeNodePainter {
public:
  // `nodes` is shared by all painters of the same tree. ErrorCode::unsupported: this GL cannot
  // compile our shaders.
  static hal::Result<TubeNodePainter> create(std::shared_ptr<NodeTexture> nodes,
                                             const TubeShape& shape);

  // Afterwards draw() draws clusters of that tree in that frame.
  hal::Result<> begin(const VesselFrame& frame, const pipeline::VesselClusters& tree);
  void draw(std::span<const PlacedCluster> clusters, bool caps) const;

private:
  struct Part { // bodies, or half balls
    gl::Program program;
    gl::VertexArray vertex_array;
    gl::Buffer indices;
    int corners = 0; // of a segment
  };

  TubeNodePainter(std::shared_ptr<NodeTexture> nodes, const TubeShape& shape, gl::Program body,
                  gl::Program caps);
  Part make_part(gl::Program program, const std::vector<std::uint32_t>& indices) const;
  static void draw(const Part& part, std::span<const PlacedCluster> clusters);

  std::shared_ptr<NodeTexture> nodes_;
  gl::Buffer instances_;
  Part body_;
  Part caps_;
  gl::Texture ends_;
  TreeKey tree_; // whose ends these are
};

} // namespace octascope::ui
