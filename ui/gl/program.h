// A linked shader program.
#pragma once

#include <string_view>

#include <GLES3/gl3.h>

#include "hal/result.h"
#include "ui/gl/objects.h"

namespace octascope::ui::gl {

// Threads: as gl/objects.h.
class Program {
public:
  // Sources without a #version line, which is added here. The error names the program and has the
  // compiler's message.
  static hal::Result<Program> build(std::string_view name, std::string_view vertex_source,
                                    std::string_view fragment_source);

  void use() const { glUseProgram(object_.name()); }
  // −1, which GL ignores, for a uniform that the compiler has optimised away.
  GLint uniform(const char* name) const { return glGetUniformLocation(object_.name(), name); }

private:
  Program() = default;
  static void create(GLsizei, GLuint* name) { *name = glCreateProgram(); }
  static void destroy(GLsizei, const GLuint* name) { glDeleteProgram(*name); }

  Object<create, destroy> object_ = Object<create, destroy>::make();
};

} // namespace octascope::ui::gl
