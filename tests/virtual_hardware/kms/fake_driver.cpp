#include "tests/virtual_hardware/kms/fake_driver.h"

#include <cstdlib>
#include <sstream>
#include <string>
#include <string_view>

#include <dlfcn.h>
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>
// Needs what the line above declares.
#include <GLES2/gl2ext.h>

namespace octascope::tests {

namespace {

FakeDriver from_environment() {
  FakeDriver driver;
  if (const char* const wanted = std::getenv("OCTASCOPE_FAKE_RESET")) {
    int after = 0, times = 0;
    std::istringstream{wanted} >> after >> times;
    driver.tells_of_resets = true;
    driver.first_reset = after + 1;
    driver.last_reset = after + times;
  }
  return driver;
}

// The library's own function of that name.
template <typename Function> Function* real(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

GLenum status() {
  FakeDriver& driver = fake_driver();
  ++driver.asked;
  const bool reset = driver.asked >= driver.first_reset && driver.asked <= driver.last_reset;
  return reset ? GL_INNOCENT_CONTEXT_RESET_KHR : driver.status;
}

bool asks_to_be_told(const std::vector<int>& attributes) {
  for (std::size_t i = 0; i + 1 < attributes.size(); i += 2)
    if (attributes[i] == EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY_EXT)
      return attributes[i + 1] == EGL_LOSE_CONTEXT_ON_RESET_EXT;
  return false;
}

} // namespace

FakeDriver& fake_driver() {
  static FakeDriver driver = from_environment();
  return driver;
}

} // namespace octascope::tests

using octascope::tests::asks_to_be_told;
using octascope::tests::fake_driver;
using octascope::tests::real;

const char* eglQueryString(EGLDisplay display, EGLint name) {
  const char* const found = real<decltype(eglQueryString)>("eglQueryString")(display, name);
  if (!fake_driver().tells_of_resets || name != EGL_EXTENSIONS || display == EGL_NO_DISPLAY)
    return found;
  static std::string with;
  with = std::string{found} + " EGL_EXT_create_context_robustness";
  return with.c_str();
}

// The real driver has never heard of resets, and is asked for a context without.
EGLContext eglCreateContext(EGLDisplay display, EGLConfig config, EGLContext shared,
                            const EGLint* attributes) {
  std::vector<int> wanted;
  for (; *attributes != EGL_NONE; ++attributes)
    wanted.push_back(*attributes);
  fake_driver().context_attributes = wanted;
  if (asks_to_be_told(wanted) && fake_driver().refuses)
    return EGL_NO_CONTEXT;
  const EGLint plain[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
  return real<decltype(eglCreateContext)>("eglCreateContext")(display, config, shared, plain);
}

__eglMustCastToProperFunctionPointerType eglGetProcAddress(const char* name) {
  const std::string_view wanted{name};
  if (wanted == "glGetGraphicsResetStatusKHR" || wanted == "glGetGraphicsResetStatusEXT")
    return reinterpret_cast<__eglMustCastToProperFunctionPointerType>(octascope::tests::status);
  return real<decltype(eglGetProcAddress)>("eglGetProcAddress")(name);
}

void glGetIntegerv(GLenum name, GLint* values) {
  if (name == GL_RESET_NOTIFICATION_STRATEGY_KHR && fake_driver().tells_of_resets)
    *values = asks_to_be_told(fake_driver().context_attributes) ? GL_LOSE_CONTEXT_ON_RESET_KHR
                                                                : GL_NO_RESET_NOTIFICATION_KHR;
  else
    real<decltype(glGetIntegerv)>("glGetIntegerv")(name, values);
}
