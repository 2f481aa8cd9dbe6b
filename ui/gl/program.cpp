#include "ui/gl/program.h"

#include <array>

#include <fmt/format.h>

namespace octascope::ui::gl {

namespace {

constexpr std::string_view version_line = "#version 300 es\n";

struct Shader {
  explicit Shader(GLenum kind) : name{glCreateShader(kind)} {}
  Shader(const Shader&) = delete;
  Shader& operator=(const Shader&) = delete;
  ~Shader() { glDeleteShader(name); }
  GLuint name;
};

hal::Result<> compile(const Shader& shader, std::string_view what, std::string_view source) {
  const std::array<const GLchar*, 2> texts{version_line.data(), source.data()};
  const std::array<GLint, 2> lengths{static_cast<GLint>(version_line.size()),
                                     static_cast<GLint>(source.size())};
  glShaderSource(shader.name, 2, texts.data(), lengths.data());
  glCompileShader(shader.name);
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader.name, GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE)
    return {};
  std::array<char, 2048> log{};
  glGetShaderInfoLog(shader.name, static_cast<GLsizei>(log.size()), nullptr, log.data());
  return hal::fail(
      hal::ErrorCode::unsupported,
      "shader {}: found an error, expected GLSL ES 3.00 that this driver ({}) compiles: {}", what,
      reinterpret_cast<const char*>(glGetString(GL_VERSION)), log.data());
}

} // namespace

hal::Result<Program> Program::build(std::string_view name, std::string_view vertex_source,
                                    std::string_view fragment_source) {
  const Shader vertex{GL_VERTEX_SHADER};
  HAL_CHECK(compile(vertex, fmt::format("{}.vert", name), vertex_source));
  const Shader fragment{GL_FRAGMENT_SHADER};
  HAL_CHECK(compile(fragment, fmt::format("{}.frag", name), fragment_source));

  Program program;
  const GLuint linked_name = program.object_.name();
  glAttachShader(linked_name, vertex.name);
  glAttachShader(linked_name, fragment.name);
  glLinkProgram(linked_name);
  GLint linked = GL_FALSE;
  glGetProgramiv(linked_name, GL_LINK_STATUS, &linked);
  if (linked != GL_TRUE) {
    std::array<char, 2048> log{};
    glGetProgramInfoLog(linked_name, static_cast<GLsizei>(log.size()), nullptr, log.data());
    return hal::fail(hal::ErrorCode::unsupported, "shader program {}: its stages do not link: {}",
                     name, log.data());
  }
  return program;
}

} // namespace octascope::ui::gl
