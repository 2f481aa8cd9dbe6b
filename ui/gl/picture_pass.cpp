#include "ui/gl/picture_pass.h"

#include "embedded_shaders.h"

namespace octascope::ui::gl {

hal::Result<PicturePass> PicturePass::create(std::string_view name,
                                             std::string_view fragment_source) {
  HAL_TRY(auto program, Program::build(name, shaders::picture_vert, fragment_source));
  return PicturePass{std::move(program)};
}

void PicturePass::fill(const Rect& rect, int target_height) const {
  glViewport(rect.x, target_height - rect.bottom(), rect.width, rect.height);
  glBindVertexArray(vertex_array_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
}

void PicturePass::blend(const Texture& picture, const Rect& rect, int target_height) const {
  use();
  glActiveTexture(GL_TEXTURE0);
  glBindTexture(GL_TEXTURE_2D, picture.name());
  glUniform1i(uniform("u_picture"), 0);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  fill(rect, target_height);
  glDisable(GL_BLEND);
}

} // namespace octascope::ui::gl
