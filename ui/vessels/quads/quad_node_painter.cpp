#include "ui/vessels/quads/quad_node_painter.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "embedded_shaders.h"

namespace octascope::ui {

namespace {

const void* offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

void describe(GLuint attribute, GLint floats, std::size_t at) {
  glEnableVertexAttribArray(attribute);
  glVertexAttribPointer(attribute, floats, GL_FLOAT, GL_FALSE, sizeof(PlacedCluster), offset(at));
  glVertexAttribDivisor(attribute, 1);
}

} // namespace

void describe_placed_clusters() {
  describe(0, 4, offsetof(PlacedCluster, across));
  describe(1, 4, offsetof(PlacedCluster, up));
  describe(2, 4, offsetof(PlacedCluster, along));
  describe(3, 2, offsetof(PlacedCluster, smallest_radius));
  glEnableVertexAttribArray(4);
  glVertexAttribIPointer(4, 4, GL_UNSIGNED_INT, sizeof(PlacedCluster),
                         offset(offsetof(PlacedCluster, first_node)));
  glVertexAttribDivisor(4, 1);
}

hal::Result<QuadNodePainter> QuadNodePainter::create(std::shared_ptr<NodeTexture> nodes) {
  const std::string head =
      std::string{shaders::vessel_nodes_glsl} + std::string{shaders::vessel_segment_glsl};
  HAL_TRY(auto programs,
          QuadPrograms::create("vessel_quad_nodes", head, shaders::vessel_quad_nodes_vert));
  return QuadNodePainter{std::move(programs), std::move(nodes)};
}

QuadNodePainter::QuadNodePainter(QuadPrograms programs, std::shared_ptr<NodeTexture> nodes)
    : programs_{std::move(programs)}, nodes_{std::move(nodes)}, instances_{gl::Buffer::make()} {
  for (std::size_t i = 0; i < quad_kind_count; ++i) {
    const auto corners = quad_indices(pipeline::largest_cluster);
    indices_[i] = gl::Buffer::make();
    vertex_arrays_[i] = gl::VertexArray::make();
    glBindVertexArray(vertex_arrays_[i].name());
    glBindBuffer(GL_ARRAY_BUFFER, instances_.name());
    describe_placed_clusters();
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_[i].name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(corners.size() * sizeof(corners.front())), corners.data(),
                 GL_STATIC_DRAW);
  }
  glBindVertexArray(0);
}

hal::Result<> QuadNodePainter::begin(const VesselFrame& frame,
                                     const pipeline::VesselClusters& tree) {
  HAL_CHECK(nodes_->show(tree));
  nodes_->bind(GL_TEXTURE0);
  programs_.begin(frame);
  return {};
}

void QuadNodePainter::draw(std::span<const PlacedCluster> clusters, QuadKind kind) const {
  if (clusters.empty())
    return;
  std::uint32_t most = 0;
  for (const PlacedCluster& cluster : clusters)
    most = std::max(most, cluster.segments);
  programs_.use(kind);
  glBindBuffer(GL_ARRAY_BUFFER, instances_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(clusters.size_bytes()), clusters.data(),
               GL_STREAM_DRAW);
  glBindVertexArray(vertex_arrays_[static_cast<std::size_t>(kind)].name());
  glDrawElementsInstanced(GL_TRIANGLES, quad_corners * static_cast<GLsizei>(most),
                          GL_UNSIGNED_SHORT, nullptr, static_cast<GLsizei>(clusters.size()));
}

} // namespace octascope::ui
