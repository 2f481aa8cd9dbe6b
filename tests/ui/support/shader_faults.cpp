#include "tests/ui/support/shader_faults.h"

#include <cstddef>
#include <string_view>
#include <utility>

#include <GLES3/gl3.h>
#include <dlfcn.h>

namespace octascope::tests {

namespace {

std::string& refused_words() {
  static std::string words;
  return words;
}

bool is_refused(std::string_view source) {
  return !refused_words().empty() && source.find(refused_words()) != std::string_view::npos;
}

} // namespace

ShaderFault::ShaderFault(std::string words) {
  refused_words() = std::move(words);
}

ShaderFault::~ShaderFault() {
  refused_words().clear();
}

} // namespace octascope::tests

// In place of the library's, which has the sources as gl::Program gives them: the version and the rest.
extern "C" void glShaderSource(GLuint shader, GLsizei count, const GLchar* const* texts,
                               const GLint* lengths) {
  using Function = decltype(glShaderSource);
  static auto* const real = reinterpret_cast<Function*>(dlsym(RTLD_NEXT, "glShaderSource"));
  bool refused = false;
  for (GLsizei i = 0; i < count; ++i)
    refused =
        refused || octascope::tests::is_refused({texts[i], static_cast<std::size_t>(lengths[i])});
  const GLchar* const nonsense = "#version 300 es\nno shader";
  if (refused)
    real(shader, 1, &nonsense, nullptr);
  else
    real(shader, count, texts, lengths);
}
