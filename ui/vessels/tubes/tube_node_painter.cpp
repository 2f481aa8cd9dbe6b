#include "ui/vessels/tubes/tube_node_painter.h"

#include <algorithm>
#include <cstddef>
#include <string>

#include "embedded_shaders.h"
#include <fmt/format.h>

#include "ui/vessels/quads/quad_node_painter.h"
#include "ui/vessels/scene/vessel_uniforms.h"
#include "ui/vessels/tubes/vessel_ends.h"

namespace octascope::ui {

namespace {

constexpr std::size_t columns =
    2048; // of words, as shaders/vessels/vessel_tube_nodes.vert reads them

gl::Texture make_ends(const pipeline::VesselClusters& tree) {
  std::vector<std::uint32_t> words = passed_nodes(tree);
  const std::size_t rows = std::max<std::size_t>(1, (words.size() + columns - 1) / columns);
  words.resize(rows * columns);
  gl::Texture texture = gl::Texture::make();
  glBindTexture(GL_TEXTURE_2D, texture.name());
  glTexStorage2D(GL_TEXTURE_2D, 1, GL_R32UI, columns, static_cast<GLsizei>(rows));
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, columns, static_cast<GLsizei>(rows), GL_RED_INTEGER,
                  GL_UNSIGNED_INT, words.data());
  return texture;
}

hal::Result<gl::Program> build(const TubeShape& shape, bool caps) {
  const std::string defines =
      fmt::format("{}#define SECTORS {}\n#define CAP_RINGS {}\n#define SEGMENT_VERTICES {}\n",
                  caps ? "#define CAPS\n" : "", shape.sectors, shape.cap_rings(),
                  caps ? 2 * shape.cap_vertices() : shape.body_vertices());
  return build_tube_program(caps ? "vessel_tube_caps" : "vessel_tube_body", defines,
                            std::string{shaders::vessel_nodes_glsl} +
                                std::string{shaders::vessel_segment_glsl},
                            shaders::vessel_tube_nodes_vert);
}

} // namespace

hal::Result<TubeNodePainter> TubeNodePainter::create(std::shared_ptr<NodeTexture> nodes,
                                                     const TubeShape& shape) {
  HAL_TRY(auto body, build(shape, false));
  HAL_TRY(auto caps, build(shape, true));
  return TubeNodePainter{std::move(nodes), shape, std::move(body), std::move(caps)};
}

TubeNodePainter::TubeNodePainter(std::shared_ptr<NodeTexture> nodes, const TubeShape& shape,
                                 gl::Program body, gl::Program caps)
    : nodes_{std::move(nodes)}, instances_{gl::Buffer::make()},
      body_{make_part(std::move(body), tube_body_indices(shape, pipeline::largest_cluster))},
      caps_{make_part(std::move(caps), tube_cap_indices(shape, 2 * pipeline::largest_cluster))} {}

TubeNodePainter::Part TubeNodePainter::make_part(gl::Program program,
                                                 const std::vector<std::uint32_t>& indices) const {
  Part part{std::move(program), gl::VertexArray::make(), gl::Buffer::make(),
            static_cast<int>(indices.size()) / pipeline::largest_cluster};
  glBindVertexArray(part.vertex_array.name());
  glBindBuffer(GL_ARRAY_BUFFER, instances_.name());
  describe_placed_clusters();
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, part.indices.name());
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(indices.size() * sizeof(indices.front())), indices.data(),
               GL_STATIC_DRAW);
  glBindVertexArray(0);
  return part;
}

hal::Result<> TubeNodePainter::begin(const VesselFrame& frame,
                                     const pipeline::VesselClusters& tree) {
  HAL_CHECK(nodes_->show(tree));
  if (tree_ != nodes_->shown()) {
    ends_ = make_ends(tree);
    tree_ = nodes_->shown();
  }
  for (const Part* part : {&body_, &caps_}) {
    set_vessel_uniforms(part->program, frame);
    glUniform1f(part->program.uniform("u_straight_px"), straight_px);
    glUniform1i(part->program.uniform("u_ends"), 1);
  }
  nodes_->bind(GL_TEXTURE0);
  glActiveTexture(GL_TEXTURE1);
  glBindTexture(GL_TEXTURE_2D, ends_.name());
  glActiveTexture(GL_TEXTURE0);
  return {};
}

void TubeNodePainter::draw(const Part& part, std::span<const PlacedCluster> clusters) {
  std::uint32_t most = 0;
  for (const PlacedCluster& cluster : clusters)
    most = std::max(most, cluster.segments);
  part.program.use();
  glBindVertexArray(part.vertex_array.name());
  glDrawElementsInstanced(GL_TRIANGLE_STRIP, part.corners * static_cast<GLsizei>(most),
                          GL_UNSIGNED_INT, nullptr, static_cast<GLsizei>(clusters.size()));
}

void TubeNodePainter::draw(std::span<const PlacedCluster> clusters, bool caps) const {
  if (clusters.empty())
    return;
  glBindBuffer(GL_ARRAY_BUFFER, instances_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(clusters.size_bytes()), clusters.data(),
               GL_STREAM_DRAW);
  draw(body_, clusters);
  if (caps)
    draw(caps_, clusters);
}

} // namespace octascope::ui
