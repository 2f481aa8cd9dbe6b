#include "ui/vessels/sections/section_painter.h"

#include <array>
#include <cstddef>

#include "embedded_shaders.h"

#include "ui/gl/kept_framebuffer.h"
#include "ui/gl/picture_texture.h"
#include "ui/gl/scissor.h"

namespace octascope::ui {

namespace {

hal::Result<> resize(SectionLayer& layer, int width, int height) {
  layer.width = layer.height = 0;
  layer.framebuffer = gl::Framebuffer::make();
  glBindFramebuffer(GL_FRAMEBUFFER, layer.framebuffer.name());
  const auto attach = [&](GLenum format, GLenum place) {
    gl::Texture texture = gl::make_picture_texture(format, width, height);
    glFramebufferTexture2D(GL_FRAMEBUFFER, place, GL_TEXTURE_2D, texture.name(), 0);
    return texture;
  };
  layer.colour = attach(GL_RGBA8, GL_COLOR_ATTACHMENT0);
  layer.depth = attach(GL_DEPTH_COMPONENT24, GL_DEPTH_ATTACHMENT);
  const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
  if (status != GL_FRAMEBUFFER_COMPLETE)
    return hal::fail(hal::ErrorCode::system,
                     "vessel display: a flat picture of {}x{} is no complete framebuffer (status "
                     "0x{:04x}); choose a smaller size",
                     width, height, status);
  layer.width = width;
  layer.height = height;
  return {};
}

const void* byte_offset(std::size_t bytes) {
  return reinterpret_cast<const void*>(bytes);
}

} // namespace

hal::Result<SectionPainter> SectionPainter::create() {
  HAL_TRY(auto program, gl::Program::build("vessel_section", shaders::vessel_section_vert,
                                           shaders::vessel_section_frag));
  HAL_TRY(auto over, gl::PicturePass::create("composite", shaders::composite_frag));
  return SectionPainter{std::move(program), std::move(over)};
}

SectionPainter::SectionPainter(gl::Program program, gl::PicturePass over)
    : program_{std::move(program)}, over_{std::move(over)}, vertex_array_{gl::VertexArray::make()},
      marks_{gl::Buffer::make()}, uniforms_{
                                      program_.uniform("u_size"), program_.uniform("u_half_line"),
                                      program_.uniform("u_line_opacity"),
                                      program_.uniform("u_reach"), program_.uniform("u_opacity")} {
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, marks_.name());
  const auto floats = [](GLuint location, GLint count, std::size_t offset) {
    glVertexAttribPointer(location, count, GL_FLOAT, GL_FALSE, sizeof(PlacedMark),
                          byte_offset(offset));
  };
  floats(0, 3, offsetof(PlacedMark, from));
  floats(1, 3, offsetof(PlacedMark, to));
  floats(2, 2, offsetof(PlacedMark, radii));
  floats(3, 2, offsetof(PlacedMark, shares));
  glVertexAttribPointer(4, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(PlacedMark),
                        byte_offset(offsetof(PlacedMark, colour)));
  for (GLuint i = 0; i < 5; ++i) {
    glEnableVertexAttribArray(i);
    glVertexAttribDivisor(i, 1);
  }
  glBindVertexArray(0);
}

hal::Result<> SectionPainter::draw(SectionLayer& layer, std::span<const PlacedMark> marks,
                                   const Style& style, int width, int height) {
  const gl::KeptFramebuffer kept;
  if (layer.width != width || layer.height != height)
    HAL_CHECK(resize(layer, width, height));
  glBindFramebuffer(GL_FRAMEBUFFER, layer.framebuffer.name());
  glViewport(0, 0, width, height);
  constexpr std::array<GLfloat, 4> nothing{0, 0, 0, 0};
  constexpr GLfloat far = 1;
  glDepthMask(GL_TRUE);
  glClearBufferfv(GL_COLOR, 0, nothing.data());
  glClearBufferfv(GL_DEPTH, 0, &far);
  if (marks.empty())
    return {};
  program_.use();
  glUniform2f(uniforms_.size, static_cast<float>(width), static_cast<float>(height));
  glUniform1f(uniforms_.half_line, style.line_px / 2);
  glUniform1f(uniforms_.line_opacity, style.line_opacity);
  glUniform1f(uniforms_.reach, style.reach_px);
  glUniform1f(uniforms_.opacity, style.opacity);
  glBindVertexArray(vertex_array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, marks_.name());
  glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(marks.size_bytes()), marks.data(),
               GL_STREAM_DRAW);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, static_cast<GLsizei>(marks.size()));
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(0);
  return {};
}

void SectionPainter::blend(const SectionLayer& layer, const Rect& covered, const Rect& rect,
                           int target_height) const {
  // Rounded outwards where a stereo picture is squeezed.
  const auto begin = [](int at, int to, int from) { return at * to / from; };
  const auto end = [](int at, int to, int from) { return (at * to + from - 1) / from; };
  const int left = rect.x + begin(covered.x, rect.width, layer.width);
  const int right = rect.x + end(covered.right(), rect.width, layer.width);
  const int top = rect.y + begin(covered.y, rect.height, layer.height);
  const int bottom = rect.y + end(covered.bottom(), rect.height, layer.height);
  const gl::Scissor clip{{left, top, right - left, bottom - top}, target_height};
  over_.blend(layer.colour, rect, target_height);
}

} // namespace octascope::ui
