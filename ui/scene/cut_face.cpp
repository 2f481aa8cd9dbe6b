#include "ui/scene/cut_face.h"

#include "embedded_shaders.h"
#include <glm/gtc/type_ptr.hpp>

#include "pipeline/volume/volume_geometry.h"

namespace octascope::ui {

hal::Result<CutFace> CutFace::create() {
  HAL_TRY(auto program,
          TransferProgram::create({"cut face", shaders::cut_face_vert, shaders::cut_face_frag}));
  return CutFace{std::move(program)};
}

void CutFace::composite(const VolumeTexture& volume, const TransferTexture& transfer,
                        const Camera& camera, const SlowRange& kept, const Rect& rect,
                        int target_height) const {
  const gl::Program& program = program_.use(transfer);
  const glm::vec3 extents = box_extents_mm(volume.geometry());
  glUniformMatrix4fv(program.uniform("u_view_projection"), 1, GL_FALSE,
                     glm::value_ptr(camera.view_projection));
  glUniform3fv(program.uniform("u_extents"), 1, glm::value_ptr(extents));
  glUniform1f(program.uniform("u_face"), kept.face());
  glUniform1f(program.uniform("u_highest"),
              (pipeline::blank_depth_bins + 0.5F) / static_cast<float>(volume.geometry().depths));
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_3D, volume.name());
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glViewport(rect.x, target_height - rect.bottom(), rect.width, rect.height);
  glBindVertexArray(vertex_array_.name());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glBindVertexArray(0);
  glDisable(GL_BLEND);
}

} // namespace octascope::ui
