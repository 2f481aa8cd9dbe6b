#include "hal/linux/kms/graphics_reset.h"

#include <EGL/eglext.h>
#include <GLES3/gl3.h>
// Needs what the line above declares.
#include <GLES2/gl2ext.h>

namespace octascope::hal::linux_backend::kms {

std::vector<std::vector<EGLint>> GraphicsReset::context_attributes(EGLDisplay display) {
  std::vector<std::vector<EGLint>> choices;
  const char* const extensions = eglQueryString(display, EGL_EXTENSIONS);
  if (extensions != nullptr && std::string_view{extensions}.find(
                                   "EGL_EXT_create_context_robustness") != std::string_view::npos)
    choices.push_back({EGL_CONTEXT_MAJOR_VERSION, 3,
                       EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT,
                       EGL_LOSE_CONTEXT_ON_RESET_EXT, EGL_NONE});
  choices.push_back({EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE});
  return choices;
}

GraphicsReset GraphicsReset::of_current_context() {
  GLint strategy = GL_NO_RESET_NOTIFICATION_KHR;
  glGetIntegerv(GL_RESET_NOTIFICATION_STRATEGY_KHR, &strategy);
  while (glGetError() != GL_NO_ERROR) { // a driver that does not know the question
  }
  GraphicsReset reset;
  if (strategy != GL_LOSE_CONTEXT_ON_RESET_KHR)
    return reset;
  for (const char* name : {"glGetGraphicsResetStatusKHR", "glGetGraphicsResetStatusEXT"})
    if (reset.status_ == nullptr)
      reset.status_ = reinterpret_cast<Status>(eglGetProcAddress(name));
  return reset;
}

// Some drivers answer what is in no specification: that is no reset.
std::optional<std::string_view> GraphicsReset::cause() const {
  switch (status_ == nullptr ? GL_NO_ERROR : status_()) {
  case GL_GUILTY_CONTEXT_RESET_KHR: return "by what octascope drew";
  case GL_INNOCENT_CONTEXT_RESET_KHR: return "by another program";
  case GL_UNKNOWN_CONTEXT_RESET_KHR: return "for a reason that the driver does not know";
  default: return std::nullopt;
  }
}

} // namespace octascope::hal::linux_backend::kms
