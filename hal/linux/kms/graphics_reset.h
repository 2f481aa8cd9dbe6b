// Detects a reset of the graphics processor. After one, drawing has no effect any more, and a
// program that does not check would keep showing stale buffers.
//
// Source: EGL_EXT_create_context_robustness, GL_EXT_robustness and GL_KHR_robustness (Khronos).
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#define EGL_NO_X11
#include <EGL/egl.h>

namespace octascope::hal::linux_backend::kms {

// Threads: the one where the context is current. cause() does not allocate.
class GraphicsReset {
public:
  // Attributes with which to create a GLES 3 context, best first: with reset notification, if
  // `display` supports it, then without.
  static std::vector<std::vector<EGLint>> context_attributes(EGLDisplay display);

  // For the current context. If it has no reset notification, no reset is ever reported.
  static GraphicsReset of_current_context();

  // After a reset: its cause, as text; the context is then unusable. Else empty.
  std::optional<std::string_view> cause() const;

private:
  using Status = unsigned (*)(); // glGetGraphicsResetStatus
  Status status_ = nullptr;      // null: the context has no reset notification
};

} // namespace octascope::hal::linux_backend::kms
