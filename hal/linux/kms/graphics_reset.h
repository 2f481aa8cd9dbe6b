// Whether the graphics processor was reset. What is drawn is lost then, and a program that does not
// ask goes on to show buffers into which nobody draws any more.
//
// Source: EGL_EXT_create_context_robustness, GL_EXT_robustness and GL_KHR_robustness (Khronos).
#pragma once

#include <optional>
#include <string_view>
#include <vector>

#define EGL_NO_X11
#include <EGL/egl.h>

namespace octascope::hal::linux_backend::kms {

// Asked on the thread where the context is current. Allocates nothing.
class GraphicsReset {
public:
  // What contexts of GLES 3 are to be created with, the best first: one that tells of resets, where
  // this display has it, then one that does not.
  static std::vector<std::vector<EGLint>> context_attributes(EGLDisplay display);

  // Of the context that is current now. Without one that tells, none is ever known.
  static GraphicsReset of_current_context();

  // After a reset: what caused it, in words. The context cannot be used any more.
  std::optional<std::string_view> cause() const;

private:
  using Status = unsigned (*)(); // glGetGraphicsResetStatus
  Status status_ = nullptr;      // null: the driver cannot tell
};

} // namespace octascope::hal::linux_backend::kms
