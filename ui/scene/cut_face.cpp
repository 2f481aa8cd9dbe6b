#include "ui/scene/cut_face.h"

#include <algorithm>

#include "embedded_shaders.h"
#include <glm/gtc/type_ptr.hpp>

#include "pipeline/volume/volume_geometry.h"

namespace octascope::ui {

hal::Result<CutFace> CutFace::create(WithFlow flow) {
  HAL_TRY(auto program,
          TransferProgram::create(
              {"cut face", shaders::cut_face_vert, shaders::cut_face_frag, {}, flow}));
  return CutFace{std::move(program)};
}

void CutFace::composite(const VolumeTexture& volume, const TransferTexture& transfer,
                        const FlowScene* flow, const Camera& camera, const CutAway& away,
                        const Rect& rect, int target_height) const {
  const gl::Program& program = program_.use(transfer, flow);
  const glm::vec3 extents = box_extents_mm(volume.geometry());
  glUniformMatrix4fv(program.uniform("u_view_projection"), 1, GL_FALSE,
                     glm::value_ptr(camera.view_projection));
  glUniform3fv(program.uniform("u_extents"), 1, glm::value_ptr(extents));
  glUniform1f(program.uniform("u_highest"),
              (pipeline::blank_depth_bins + 0.5F) / static_cast<float>(volume.geometry().depths));
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_3D, volume.name());
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glViewport(rect.x, target_height - rect.bottom(), rect.width, rect.height);
  glBindVertexArray(vertex_array_.name());
  for (const int axis : {0, 1})
    if (away.has_face(axis))
      draw_face(program, away, axis);
  glBindVertexArray(0);
  glDisable(GL_BLEND);
}

// Across that axis, as far as the cut goes along the other one.
void CutFace::draw_face(const gl::Program& program, const CutAway& away, int across) const {
  const int along = 1 - across;
  glm::vec2 begin{away.face(across)};
  glm::vec2 end{away.face(across)};
  begin[along] = std::max(away.from[along], 0.0F);
  end[along] = std::min(away.to[along], 1.0F);
  glUniform4f(program.uniform("u_face"), begin.x, begin.y, end.x, end.y);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

} // namespace octascope::ui
