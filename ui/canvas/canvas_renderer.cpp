#include "ui/canvas/canvas_renderer.h"

#include <cmath>
#include <cstddef>

#include "embedded_shaders.h"
#include <imgui.h>

namespace octascope::ui {

namespace {

void set_scissor(const ImVec4& clip, const EyeFrame& frame, int target_height) {
  const auto left = static_cast<int>(std::floor(clip.x));
  const auto top = static_cast<int>(std::floor(clip.y));
  const Rect rect = frame.place({left, top, static_cast<int>(std::ceil(clip.z)) - left,
                                 static_cast<int>(std::ceil(clip.w)) - top});
  glScissor(rect.x, target_height - rect.bottom(), rect.width, rect.height);
}

const void* byte_offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

} // namespace

hal::Result<CanvasRenderer> CanvasRenderer::create() {
  HAL_TRY(auto program, gl::Program::build("hud", shaders::hud_vert, shaders::hud_frag));
  return CanvasRenderer{std::move(program)};
}

CanvasRenderer::CanvasRenderer(gl::Program program)
    : program_{std::move(program)}, vertex_array_{gl::VertexArray::make()},
      vertices_{gl::Buffer::make()}, indices_{gl::Buffer::make()} {
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
  for (GLuint i = 0; i < 3; ++i)
    glEnableVertexAttribArray(i);
  constexpr GLsizei stride = sizeof(ImDrawVert);
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, stride, byte_offset(offsetof(ImDrawVert, pos)));
  glVertexAttribPointer(1, 2, GL_FLOAT, GL_FALSE, stride, byte_offset(offsetof(ImDrawVert, uv)));
  glVertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, stride,
                        byte_offset(offsetof(ImDrawVert, col)));
  glBindVertexArray(0);
}

void CanvasRenderer::draw(const Canvas& canvas, const EyeFrame& frame, int target_height) const {
  const ImDrawList& list = canvas.list();
  if (list.VtxBuffer.empty())
    return;
  const Rect& target = frame.target;
  glViewport(target.x, target_height - target.bottom(), target.width, target.height);
  program_.use();
  glUniform2f(program_.uniform("u_size"), static_cast<float>(frame.width),
              static_cast<float>(frame.height));
  glUniform1i(program_.uniform("u_glyphs"), 0);
  glActiveTexture(GL_TEXTURE0);
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  glBufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data,
               GL_STREAM_DRAW);
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data,
               GL_STREAM_DRAW);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  glEnable(GL_SCISSOR_TEST);
  for (const ImDrawCmd& command : list.CmdBuffer) {
    if (command.ElemCount == 0)
      continue;
    set_scissor(command.ClipRect, frame, target_height);
    glBindTexture(GL_TEXTURE_2D,
                  static_cast<GLuint>(reinterpret_cast<std::uintptr_t>(command.GetTexID())));
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(command.ElemCount), GL_UNSIGNED_SHORT,
                   byte_offset(command.IdxOffset * sizeof(ImDrawIdx)));
  }
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
  glBindVertexArray(0);
}

} // namespace octascope::ui
