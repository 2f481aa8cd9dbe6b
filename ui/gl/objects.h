// Ownership of GL names: one deleter per kind, moved and never copied.
//
// Threads: made, used and destroyed on the thread whose context is current.
#pragma once

#include <utility>

#include <GLES3/gl3.h>

namespace octascope::ui::gl {

template <void (*generate)(GLuint&), void (*destroy)(GLuint)> class Object {
public:
  Object() = default;
  static Object make() {
    Object object;
    generate(object.name_);
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
      destroy(name_);
  }

  GLuint name() const { return name_; }
  explicit operator bool() const { return name_ != 0; }

private:
  GLuint name_ = 0;
};

inline void generate_texture(GLuint& name) {
  glGenTextures(1, &name);
}
inline void destroy_texture(GLuint name) {
  glDeleteTextures(1, &name);
}
inline void generate_buffer(GLuint& name) {
  glGenBuffers(1, &name);
}
inline void destroy_buffer(GLuint name) {
  glDeleteBuffers(1, &name);
}
inline void generate_vertex_array(GLuint& name) {
  glGenVertexArrays(1, &name);
}
inline void destroy_vertex_array(GLuint name) {
  glDeleteVertexArrays(1, &name);
}
inline void generate_framebuffer(GLuint& name) {
  glGenFramebuffers(1, &name);
}
inline void destroy_framebuffer(GLuint name) {
  glDeleteFramebuffers(1, &name);
}

using Texture = Object<generate_texture, destroy_texture>;
using Buffer = Object<generate_buffer, destroy_buffer>;
using VertexArray = Object<generate_vertex_array, destroy_vertex_array>;
using Framebuffer = Object<generate_framebuffer, destroy_framebuffer>;

} // namespace octascope::ui::gl
