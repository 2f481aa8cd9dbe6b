#include "ui/vessels/tubes/tube_stream_painter.h"

#include <algorithm>
#include <cstddef>

#include "embedded_shaders.h"

#include "ui/vessels/scene/vessel_uniforms.h"

namespace octascope::ui {

namespace {

constexpr std::size_t slot_bytes = std::size_t{4} << 20U; // about what a processor's cache holds

// A body and two half balls of each segment.
std::size_t cluster_vertices(const TubeShape& shape) {
  return static_cast<std::size_t>(pipeline::largest_cluster) *
         static_cast<std::size_t>(shape.body_vertices() + 2 * shape.cap_vertices());
}

std::uint32_t clusters_in_slot(const TubeShape& shape) {
  const std::size_t clusters = slot_bytes / (cluster_vertices(shape) * sizeof(TubeVertex));
  return static_cast<std::uint32_t>(std::clamp<std::size_t>(clusters, 1, 16));
}

const void* offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

} // namespace

hal::Result<TubeStreamPainter> TubeStreamPainter::create(std::uint32_t slots,
                                                         const TubeShape& shape) {
  HAL_TRY(auto program,
          build_tube_program("vessel_tube_stream", {}, {}, shaders::vessel_tube_stream_vert));
  return TubeStreamPainter{std::move(program), slots, shape};
}

TubeStreamPainter::TubeStreamPainter(gl::Program program, std::uint32_t slots,
                                     const TubeShape& shape)
    : program_{std::move(program)}, expander_{shape}, batch_clusters_{clusters_in_slot(shape)},
      caps_at_{std::size_t{batch_clusters_} * pipeline::largest_cluster *
               static_cast<std::size_t>(shape.body_vertices())},
      slots_{slots, batch_clusters_ * cluster_vertices(shape) * sizeof(TubeVertex)},
      counts_(slots) {
  const int segments = static_cast<int>(batch_clusters_) * pipeline::largest_cluster;
  bodies_ = make_part(tube_body_indices(shape, segments), tube_body_corners(shape), 0);
  caps_ = make_part(tube_cap_indices(shape, 2 * segments), tube_cap_corners(shape), caps_at_);
}

TubeStreamPainter::Part TubeStreamPainter::make_part(const std::vector<std::uint32_t>& indices,
                                                     int corners, std::size_t first) const {
  Part part{{}, gl::Buffer::make(), corners};
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, part.indices.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(indices.size() * sizeof(indices.front())),
               indices.data(), GL_STATIC_DRAW);
  const std::size_t at = first * sizeof(TubeVertex);
  for (std::size_t slot = 0; slot < slots_.count(); ++slot) {
    part.vertex_arrays.push_back(gl::VertexArray::make());
    glBindVertexArray(part.vertex_arrays.back().name());
    glBindBuffer(GL_ARRAY_BUFFER, slots_.name(slot));
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(TubeVertex), offset(at));
    glEnableVertexAttribArray(1);
    glVertexAttribPointer(1, 4, GL_SHORT, GL_FALSE, sizeof(TubeVertex),
                          offset(at + offsetof(TubeVertex, normal)));
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, part.indices.name());
  }
  glBindVertexArray(0);
  return part;
}

hal::Result<> TubeStreamPainter::begin(const VesselFrame& frame) {
  set_vessel_uniforms(program_, frame);
  for (std::size_t slot = 0; slot < slots_.count(); ++slot)
    HAL_CHECK(slots_.open(slot));
  return {};
}

void TubeStreamPainter::expand(std::uint32_t slot, const VesselFrame& frame,
                               std::span<const PlacedCluster> clusters,
                               std::span<const pipeline::PackedNode> nodes,
                               std::span<const std::uint32_t> passed, bool caps) {
  counts_[slot] = {};
  auto* const to = reinterpret_cast<TubeVertex*>(slots_.memory(slot));
  if (to == nullptr)
    return; // draw() has said so
  for (const PlacedCluster& cluster : clusters)
    expander_.expand(frame, cluster, nodes, passed, caps, to, to + caps_at_, counts_[slot]);
}

void TubeStreamPainter::draw(const Part& part, std::uint32_t slot, std::uint32_t count) {
  if (count == 0)
    return;
  glBindVertexArray(part.vertex_arrays[slot].name());
  glDrawElements(GL_TRIANGLE_STRIP, part.corners * static_cast<GLsizei>(count), GL_UNSIGNED_INT,
                 nullptr);
}

hal::Result<> TubeStreamPainter::draw(std::uint32_t slot) {
  const TubeExpander::Counts counts = counts_[slot];
  if (counts.bodies == 0)
    return {}; // still open
  slots_.close(slot);
  program_.use();
  draw(bodies_, slot, counts.bodies);
  draw(caps_, slot, counts.caps);
  return slots_.open(slot);
}

} // namespace octascope::ui
