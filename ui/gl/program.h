// A linked shader program.
#pragma once

#include <string_view>

#include <GLES3/gl3.h>

#include "hal/result.h"

namespace octascope::ui::gl {

// Threads: as gl/objects.h.
class Program {
public:
  // Sources come without their #version line, which is added here. The error names the program and
  // quotes the compiler.
  static hal::Result<Program> build(std::string_view name, std::string_view vertex_source,
                                    std::string_view fragment_source);

  Program(Program&& other) noexcept;
  Program& operator=(Program&& other) noexcept;
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program();

  void use() const { glUseProgram(name_); }
  // −1, which GL ignores, for a uniform that the compiler optimised away.
  GLint uniform(const char* name) const { return glGetUniformLocation(name_, name); }

private:
  explicit Program(GLuint name) : name_{name} {}
  GLuint name_ = 0;
};

} // namespace octascope::ui::gl
