#include "ui/volume/plane_stack.h"

#include <algorithm>

#include "embedded_shaders.h"
#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "ui/window.h"

namespace octascope::ui {

namespace {
constexpr std::size_t most_planes = 1024;      // what draw() takes
constexpr std::size_t vertices_per_plane = 12; // a hexagon is a fan of four triangles

// Around zero delay the volume holds what is left of the background, blurred over two bins by the
// spectral window: a bright lid over the tissue. The volume's picture leaves it out; B-scan and
// exports show it. As a share of the depth, up to the middle of the first bin that is shown.
float first_depth_share(int depths) {
  constexpr float blank_bins = 2;
  return (blank_bins + 0.5F) / static_cast<float>(depths);
}

} // namespace

hal::Result<PlaneStack> PlaneStack::create() {
  auto program =
      gl::Program::build("plane_stack", shaders::plane_stack_vert, shaders::plane_stack_frag);
  if (!program)
    return tl::make_unexpected(program.error());
  return PlaneStack{std::move(*program)};
}

PlaneStack::PlaneStack(gl::Program program)
    : program_{std::move(program)}, vertex_array_{gl::VertexArray::make()},
      vertex_buffer_{gl::Buffer::make()}, vertices_(most_planes * vertices_per_plane),
      uniforms_{program_.uniform("u_view_projection"), program_.uniform("u_eye"),
                program_.uniform("u_forward"),         program_.uniform("u_extents"),
                program_.uniform("u_levels"),          program_.uniform("u_window"),
                program_.uniform("u_opacity"),         program_.uniform("u_steps"),
                program_.uniform("u_first_depth"),     program_.uniform("u_spacing")} {
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertex_buffer_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices_.size() * sizeof(glm::vec3)),
               nullptr, GL_STREAM_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
  glBindVertexArray(0);
}

int PlaneStack::fill_vertices(const Camera& camera, const glm::vec3& half,
                              const StackSpacing& spacing, int planes) {
  const float eye_offset = glm::dot(camera.eye, camera.forward);
  std::size_t used = 0;
  for (int i = 0; i < planes; ++i) {
    const float distance = spacing.first_mm + static_cast<float>(i) * spacing.spacing_mm;
    const PlanePolygon polygon = intersect_plane_box(half, camera.forward, eye_offset + distance);
    for (std::size_t k = 2; k < static_cast<std::size_t>(polygon.count); ++k) {
      vertices_[used++] = polygon.corners[0];
      vertices_[used++] = polygon.corners[k - 1];
      vertices_[used++] = polygon.corners[k];
    }
  }
  return static_cast<int>(used);
}

void PlaneStack::draw(const VolumeTexture& volume, const Camera& camera, const ViewState& view,
                      int planes) {
  planes = std::clamp(planes, 2, static_cast<int>(most_planes));
  const glm::vec3 extents = box_extents_mm(volume.geometry());
  const glm::vec3 half = extents / 2.0F;
  const StackSpacing spacing = space_planes(camera, half, planes);
  const int count = fill_vertices(camera, half, spacing, planes);
  const WindowRamp window = window_ramp(view);

  program_.use();
  glUniformMatrix4fv(uniforms_.view_projection, 1, GL_FALSE,
                     glm::value_ptr(camera.view_projection));
  glUniform3fv(uniforms_.eye, 1, glm::value_ptr(camera.eye));
  glUniform3fv(uniforms_.forward, 1, glm::value_ptr(camera.forward));
  glUniform3fv(uniforms_.extents, 1, glm::value_ptr(extents));
  glUniform1i(uniforms_.levels, 0);
  glUniform2f(uniforms_.window, window.scale, window.offset);
  glUniform1f(uniforms_.opacity, view.opacity);
  glUniform1f(uniforms_.steps, spacing.spacing_mm / reference_step_mm(half));
  glUniform1f(uniforms_.first_depth, first_depth_share(volume.geometry().depths));
  glUniform1f(uniforms_.spacing, spacing.spacing_mm);

  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_3D, volume.name());
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertex_buffer_.name());
  glBufferSubData(GL_ARRAY_BUFFER, 0,
                  static_cast<GLsizeiptr>(static_cast<std::size_t>(count) * sizeof(glm::vec3)),
                  vertices_.data());
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);
  glDrawArrays(GL_TRIANGLES, 0, count);
  glDisable(GL_BLEND);
  glBindVertexArray(0);
}

} // namespace octascope::ui
