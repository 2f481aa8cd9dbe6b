#include "ui/canvas/canvas_renderer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "embedded_shaders.h"
#include <imgui.h>

#include "ui/gl/scissor.h"

namespace octascope::ui {

namespace {

Rect pixels_of(const ImVec4& clip) {
  const auto left = static_cast<int>(std::floor(clip.x));
  const auto top = static_cast<int>(std::floor(clip.y));
  return {left, top, static_cast<int>(std::ceil(clip.z)) - left,
          static_cast<int>(std::ceil(clip.w)) - top};
}

bool contains(const Rect& whole, const Rect& part) {
  return common(whole, part) == part;
}

// With a pixel to spare.
bool may_meet(const ImDrawVert& a, const ImDrawVert& b, const ImDrawVert& c, const Rect& rect) {
  return std::min({a.pos.x, b.pos.x, c.pos.x}) <= static_cast<float>(rect.right() + 1) &&
         std::max({a.pos.x, b.pos.x, c.pos.x}) >= static_cast<float>(rect.x - 1) &&
         std::min({a.pos.y, b.pos.y, c.pos.y}) <= static_cast<float>(rect.bottom() + 1) &&
         std::max({a.pos.y, b.pos.y, c.pos.y}) >= static_cast<float>(rect.y - 1);
}

const void* byte_offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

constexpr std::size_t most_parts = 64; // that a frame has (ui/damage/damage.h)

} // namespace

hal::Result<CanvasRenderer> CanvasRenderer::create() {
  HAL_TRY(auto program, gl::Program::build("hud", shaders::hud_vert, shaders::hud_frag));
  return CanvasRenderer{std::move(program)};
}

CanvasRenderer::CanvasRenderer(gl::Program program)
    : program_{std::move(program)}, vertex_array_{gl::VertexArray::make()},
      vertices_{gl::Buffer::make()}, indices_{gl::Buffer::make()} {
  constexpr std::size_t usual_indices = 1 << 16;
  drawn_.reserve(usual_indices);
  runs_.reserve(1024);
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

// The triangles that may be seen in `part`; all of them where it is the whole target.
void CanvasRenderer::collect(const Canvas& canvas, const EyeFrame& frame, const Rect& part) {
  const ImDrawList& list = canvas.list();
  const bool all = contains(part, frame.target);
  for (const ImDrawCmd& command : list.CmdBuffer) {
    Run run{.clip = common(frame.place(pixels_of(command.ClipRect)), part),
            .texture = static_cast<GLuint>(reinterpret_cast<std::uintptr_t>(command.GetTexID())),
            .first = drawn_.size()};
    if (run.clip.empty())
      continue;
    const ImDrawIdx* index = list.IdxBuffer.Data + command.IdxOffset;
    const ImDrawVert* vertices = list.VtxBuffer.Data;
    for (unsigned i = 0; i + 2 < command.ElemCount; i += 3, index += 3)
      if (all || may_meet(vertices[index[0]], vertices[index[1]], vertices[index[2]], run.clip))
        drawn_.insert(drawn_.end(), index, index + 3);
    run.count = drawn_.size() - run.first;
    if (run.count > 0)
      runs_.push_back(run);
  }
}

// A large triangle lies in many parts, and a command in each may be a run of its own.
void CanvasRenderer::make_room(std::size_t indices, std::size_t commands) {
  if (drawn_.capacity() < 2 * indices)
    drawn_.reserve(4 * indices);
  if (runs_.capacity() < most_parts * commands)
    runs_.reserve(2 * most_parts * commands);
}

void CanvasRenderer::draw(const Canvas& canvas, const EyeFrame& frame, int target_height,
                          std::span<const Rect> parts) {
  const ImDrawList& list = canvas.list();
  drawn_.clear();
  runs_.clear();
  make_room(static_cast<std::size_t>(list.IdxBuffer.Size),
            static_cast<std::size_t>(list.CmdBuffer.Size));
  for (const Rect& part : parts)
    collect(canvas, frame, part);
  if (runs_.empty())
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
  glBufferData(GL_ELEMENT_ARRAY_BUFFER,
               static_cast<GLsizeiptr>(drawn_.size() * sizeof(drawn_.front())), drawn_.data(),
               GL_STREAM_DRAW);
  glEnable(GL_BLEND);
  glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  for (const Run& run : runs_) {
    const gl::Scissor clip{run.clip, target_height};
    glBindTexture(GL_TEXTURE_2D, run.texture);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(run.count), GL_UNSIGNED_SHORT,
                   byte_offset(run.first * sizeof(drawn_.front())));
  }
  glDisable(GL_BLEND);
  glBindVertexArray(0);
}

} // namespace octascope::ui
