// A GL that does not compile some shaders.
#pragma once

#include <string>

namespace octascope::tests {

// While it lives, no shader compiles that has these words. One at a time, of the thread that has the GL.
class ShaderFault {
public:
  explicit ShaderFault(std::string words);
  ShaderFault(const ShaderFault&) = delete;
  ShaderFault& operator=(const ShaderFault&) = delete;
  ~ShaderFault();
};

} // namespace octascope::tests
