// Owners of GL names, movable but not copyable.
//
// Threads: create, use and destroy on the thread whose context is current.
#pragma once

#include <utility>

#include <GLES3/gl3.h>

namespace octascope::ui::gl {

template <void (*generate)(GLsizei, GLuint*), void (*destroy)(GLsizei, const GLuint*)>
class Object {
public:
  Object() = default;
  static Object make() {
    Object object;
    generate(1, &object.name_);
    return object;
  }
  Object(Object&& other) noexcept : name_{std::exchange(other.name_, 0)} {}
  Object& operator=(Object&& other) noexcept {
    std::swap(name_, other.name_);
    return *this;
  }
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;
  ~Object() {
    if (name_ != 0)
      destroy(1, &name_);
  }

  GLuint name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

private:
  GLuint name_ = 0;
};

using Texture = Object<glGenTextures, glDeleteTextures>;
using Buffer = Object<glGenBuffers, glDeleteBuffers>;
using VertexArray = Object<glGenVertexArrays, glDeleteVertexArrays>;
using Framebuffer = Object<glGenFramebuffers, glDeleteFramebuffers>;

} // namespace octascope::ui::gl
