#include "ui/vessels/quads/quad_stream_painter.h"

#include <cstddef>

#include "embedded_shaders.h"

namespace octascope::ui {

namespace {

constexpr std::size_t slot_bytes = std::size_t{QuadStreamPainter::batch_clusters} *
                                   pipeline::largest_cluster *
                                   static_cast<std::size_t>(quad_vertices) * sizeof(QuadVertex);
static_assert(QuadStreamPainter::batch_clusters * pipeline::largest_cluster <= most_quads);

const void* offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

void describe_quad_vertices() {
  for (const GLuint attribute : {0U, 1U, 2U})
    glEnableVertexAttribArray(attribute);
  constexpr std::size_t shape = offsetof(SegmentOutline, radius);
  glVertexAttribPointer(0, 4, GL_FLOAT, GL_FALSE, sizeof(QuadVertex), nullptr);
  glVertexAttribPointer(1, 4, GL_FLOAT, GL_FALSE, sizeof(QuadVertex), offset(shape));
  glVertexAttribIPointer(2, 1, GL_UNSIGNED_INT, sizeof(QuadVertex),
                         offset(offsetof(QuadVertex, colour)));
}

} // namespace

hal::Result<QuadStreamPainter> QuadStreamPainter::create(std::uint32_t slots) {
  HAL_TRY(auto programs,
          QuadPrograms::create("vessel_quad_stream", {}, shaders::vessel_quad_stream_vert));
  return QuadStreamPainter{std::move(programs), slots};
}

QuadStreamPainter::QuadStreamPainter(QuadPrograms programs, std::uint32_t slots)
    : programs_{std::move(programs)}, slots_{slots, slot_bytes}, segments_(slots) {
  for (std::uint32_t slot = 0; slot < slots; ++slot) {
    vertex_arrays_.push_back(gl::VertexArray::make());
    glBindVertexArray(vertex_arrays_.back().name());
    glBindBuffer(GL_ARRAY_BUFFER, slots_.name(slot));
    describe_quad_vertices();
  }
  glBindVertexArray(0);
  for (std::size_t kind = 0; kind < quad_kind_count; ++kind) {
    const auto corners = quad_indices(most_quads);
    indices_[kind] = gl::Buffer::make();
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_[kind].name());
    glBufferData(GL_ELEMENT_ARRAY_BUFFER,
                 static_cast<GLsizeiptr>(corners.size() * sizeof(corners.front())), corners.data(),
                 GL_STATIC_DRAW);
  }
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, 0);
}

hal::Result<> QuadStreamPainter::begin(const VesselFrame& frame) {
  programs_.begin(frame);
  for (std::size_t slot = 0; slot < slots_.count(); ++slot)
    HAL_CHECK(slots_.open(slot));
  return {};
}

void QuadStreamPainter::expand(std::uint32_t slot, const VesselFrame& frame,
                               std::span<const PlacedCluster> clusters,
                               std::span<const pipeline::PackedNode> nodes) {
  segments_[slot] = 0;
  if (slots_.memory(slot) == nullptr)
    return; // draw() has said so
  auto* to = reinterpret_cast<QuadVertex*>(slots_.memory(slot));
  const auto vertices = static_cast<std::size_t>(quad_vertices);
  std::uint32_t segments = 0;
  for (const PlacedCluster& cluster : clusters)
    segments += expand_quads(frame, cluster, nodes, to + segments * vertices);
  segments_[slot] = segments;
}

hal::Result<> QuadStreamPainter::draw(std::uint32_t slot, QuadKind kind) {
  if (segments_[slot] == 0)
    return {}; // still open
  slots_.close(slot);
  programs_.use(kind);
  glBindVertexArray(vertex_arrays_[slot].name());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_[static_cast<std::size_t>(kind)].name());
  glDrawElements(GL_TRIANGLES, quad_corners * static_cast<GLsizei>(segments_[slot]),
                 GL_UNSIGNED_SHORT, nullptr);
  return slots_.open(slot);
}

} // namespace octascope::ui
