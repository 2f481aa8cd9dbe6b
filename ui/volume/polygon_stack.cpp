#include "ui/volume/polygon_stack.h"

#include "embedded_shaders.h"
#include <glm/gtc/type_ptr.hpp>

#include "pipeline/volume/volume_geometry.h"

namespace octascope::ui {

namespace {

constexpr std::size_t vertices_per_polygon = 12; // a hexagon is a fan of four triangles

// As a share of the depth, up to the middle of the first bin that is shown.
float first_depth_share(int depths) {
  return (pipeline::blank_depth_bins + 0.5F) / static_cast<float>(depths);
}

} // namespace

hal::Result<PolygonStack> PolygonStack::create(WithFlow flow) {
  HAL_TRY(auto program,
          TransferProgram::create({"stack", shaders::stack_vert, shaders::stack_frag, {}, flow}));
  return PolygonStack{std::move(program)};
}

PolygonStack::PolygonStack(TransferProgram program)
    : program_{std::move(program)}, vertex_array_{gl::VertexArray::make()},
      vertex_buffer_{gl::Buffer::make()}, vertices_(most_polygons * vertices_per_polygon) {
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertex_buffer_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices_.size() * sizeof(glm::vec3)),
               nullptr, GL_STREAM_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(glm::vec3), nullptr);
  glBindVertexArray(0);
}

void PolygonStack::add(const PlanePolygon& polygon) {
  if (used_ + vertices_per_polygon > vertices_.size())
    return;
  for (std::size_t k = 2; k < static_cast<std::size_t>(polygon.count); ++k) {
    vertices_[used_++] = polygon.corners[0];
    vertices_[used_++] = polygon.corners[k - 1];
    vertices_[used_++] = polygon.corners[k];
  }
}

void PolygonStack::draw(const VolumeScene& scene, const Spacing& spacing) {
  const glm::vec3 extents = box_extents_mm(scene.volume.geometry());
  const gl::Program& program = program_.use(scene.transfer, scene.flow);
  glUniformMatrix4fv(program.uniform("u_view_projection"), 1, GL_FALSE,
                     glm::value_ptr(scene.camera.view_projection));
  glUniform3fv(program.uniform("u_eye"), 1, glm::value_ptr(scene.camera.eye));
  glUniform3fv(program.uniform("u_normal"), 1, glm::value_ptr(spacing.normal));
  glUniform3fv(program.uniform("u_extents"), 1, glm::value_ptr(extents));
  glUniform1f(program.uniform("u_spacing"), spacing.mm);
  glUniform1f(program.uniform("u_steps"), spacing.mm / reference_step_mm(extents / 2.0F));
  glUniform1f(program.uniform("u_dither"), spacing.dithered ? 1.0F : 0.0F);
  glUniform1f(program.uniform("u_first_depth"), first_depth_share(scene.volume.geometry().depths));
  const CutAway& away = scene.cut_away;
  glUniform4f(program.uniform("u_cut_away"), away.from.x, away.from.y, away.to.x, away.to.y);

  glUniform3fv(program.uniform("u_forward"), 1, glm::value_ptr(scene.camera.forward));
  set_depth_mask(program, scene.vessels, scene.camera);

  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_3D, scene.volume.name());
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertex_buffer_.name());
  glBufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(used_ * sizeof(glm::vec3)),
                  vertices_.data());
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE_MINUS_DST_ALPHA, GL_ONE);
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(used_));
  glDisable(GL_BLEND);
  glBindVertexArray(0);
}

} // namespace octascope::ui
