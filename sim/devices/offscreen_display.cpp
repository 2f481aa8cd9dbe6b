#include "sim/devices/offscreen_display.h"

#include <array>
#include <charconv>
#include <fstream>
#include <limits>
#include <string>
#include <string_view>

#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>

namespace octascope::sim {

namespace {

using hal::ErrorCode;

bool has_extension(const char* list, std::string_view name) {
  return list != nullptr && std::string_view{list}.find(name) != std::string_view::npos;
}

// Surfaceless where Mesa is; the default display else (vendor drivers render to a pbuffer there).
EGLDisplay find_display() {
  const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  if (has_extension(client, "EGL_MESA_platform_surfaceless")) {
    const EGLDisplay display =
        eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE)
      return display;
  }
  const EGLDisplay display = eglGetDisplay(EGL_DEFAULT_DISPLAY);
  if (display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) == EGL_TRUE)
    return display;
  return EGL_NO_DISPLAY;
}

// Linux would rather end the program, or another, than refuse memory. Where the system does not say
// how much there is, nothing is refused.
std::uint64_t available_memory() {
  constexpr std::string_view key = "MemAvailable:";
  std::ifstream in{"/proc/meminfo"};
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(key))
      continue;
    const std::size_t digits = line.find_first_of("0123456789");
    std::uint64_t kib = 0;
    if (digits != line.npos &&
        std::from_chars(line.data() + digits, line.data() + line.size(), kib).ec == std::errc{})
      return kib * 1024;
  }
  return std::numeric_limits<std::uint64_t>::max();
}

tl::unexpected<hal::Error> no_gles(std::string_view found) {
  return hal::fail(ErrorCode::unsupported,
                   "offscreen display: {} (EGL error 0x{:04x}), expected an EGL with GLES 3; "
                   "install libegl-mesa0 and libgl1-mesa-dri",
                   found, static_cast<unsigned>(eglGetError()));
}

} // namespace

hal::Result<> check_picture_memory(int width, int height, std::uint64_t available_bytes) {
  // The most that any takes: the picture 4; vessels that the processor draws, with their depth,
  // 32; read back, twice, 8.
  constexpr std::uint64_t bytes_per_pixel = 44;
  const std::uint64_t needed =
      bytes_per_pixel * static_cast<std::uint64_t>(width) * static_cast<std::uint64_t>(height);
  if (needed <= available_bytes)
    return {};
  constexpr double gib = 1 << 30;
  return hal::fail(
      ErrorCode::invalid_argument,
      "offscreen display: a picture of {}x{} takes {:.1f} GiB of memory to draw, found "
      "{:.1f} GiB available; choose a smaller size or end other programs",
      width, height, static_cast<double>(needed) / gib, static_cast<double>(available_bytes) / gib);
}

// The EGL display itself is never terminated: EGL shares it within the process, and another
// context may live on it.
struct OffscreenDisplay::Surface {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  EGLSurface pbuffer = EGL_NO_SURFACE;
  GLuint framebuffer = 0;
  GLuint colour = 0;

  Surface() = default;
  Surface(const Surface&) = delete;
  Surface& operator=(const Surface&) = delete;

  ~Surface() {
    if (context != EGL_NO_CONTEXT) {
      if (eglGetCurrentContext() == context) {
        glDeleteFramebuffers(1, &framebuffer);
        glDeleteRenderbuffers(1, &colour);
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
      }
      eglDestroyContext(display, context);
    }
    if (pbuffer != EGL_NO_SURFACE)
      eglDestroySurface(display, pbuffer);
  }

  hal::Result<> make_context() {
    display = find_display();
    if (display == EGL_NO_DISPLAY)
      return no_gles("no EGL display could be initialised");
    eglBindAPI(EGL_OPENGL_ES_API);
    const std::array<EGLint, 11> wanted{EGL_RENDERABLE_TYPE,
                                        EGL_OPENGL_ES3_BIT,
                                        EGL_SURFACE_TYPE,
                                        EGL_PBUFFER_BIT,
                                        EGL_RED_SIZE,
                                        8,
                                        EGL_GREEN_SIZE,
                                        8,
                                        EGL_BLUE_SIZE,
                                        8,
                                        EGL_NONE};
    EGLConfig egl_config = nullptr;
    EGLint found = 0;
    if (eglChooseConfig(display, wanted.data(), &egl_config, 1, &found) != EGL_TRUE || found == 0)
      return no_gles("no EGL configuration with GLES 3 and a pbuffer");
    const std::array<EGLint, 3> version{EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    context = eglCreateContext(display, egl_config, EGL_NO_CONTEXT, version.data());
    if (context == EGL_NO_CONTEXT)
      return no_gles("no GLES 3 context could be made");
    if (!has_extension(eglQueryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context")) {
      const std::array<EGLint, 5> size{EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
      pbuffer = eglCreatePbufferSurface(display, egl_config, size.data());
    }
    if (eglMakeCurrent(display, pbuffer, pbuffer, context) != EGL_TRUE)
      return no_gles("the GLES 3 context could not be made current");
    return {};
  }

  hal::Result<> make_framebuffer(int width, int height) {
    GLint largest = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &largest);
    if (width > largest || height > largest)
      return hal::fail(
          ErrorCode::invalid_argument,
          "offscreen display: size is {}x{}, expected at most {} either way on this machine", width,
          height, largest);
    HAL_CHECK(check_picture_memory(width, height, available_memory()));
    glGenRenderbuffers(1, &colour);
    glBindRenderbuffer(GL_RENDERBUFFER, colour);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
      return hal::fail(
          ErrorCode::system,
          "offscreen display: a framebuffer of {}x{} is incomplete; try a smaller size", width,
          height);
    glViewport(0, 0, width, height);
    glClearColor(0, 0, 0, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    return {};
  }
};

OffscreenDisplay::OffscreenDisplay(hal::Clock& clock) : clock_{clock} {}

OffscreenDisplay::~OffscreenDisplay() {
  do_close();
}

hal::Result<> OffscreenDisplay::do_open(const hal::DisplayConfig& config) {
  if (lost_.load(std::memory_order_acquire))
    return hal::fail(ErrorCode::absent, "offscreen display: lost; waiting for it to be restored");

  auto surface = std::make_unique<Surface>();
  HAL_CHECK(surface->make_context());
  HAL_CHECK(surface->make_framebuffer(config.width, config.height));
  surface_ = std::move(surface);
  width_ = config.width;
  height_ = config.height;
  refresh_period_ = hal::from_seconds(1.0 / config.refresh_hz);
  context_lost_.store(false, std::memory_order_release);
  opened_ = clock_.now();
  flips_ = 0;
  set_state(hal::DeviceState::ready);
  return {};
}

hal::Result<hal::Flip> OffscreenDisplay::do_present() {
  if (state() == hal::DeviceState::absent)
    return hal::fail(ErrorCode::absent, "offscreen display: not open; open() it first");
  if (context_lost_.load(std::memory_order_acquire)) {
    surface_.reset();
    set_state(hal::DeviceState::failed);
    return hal::fail(ErrorCode::disconnected,
                     "offscreen display: lost while drawing; close() it and open() it again");
  }
  glFinish();
  const hal::TimePoint completed = clock_.now();
  const std::int64_t ticks = (completed - opened_) / refresh_period_;
  clock_.sleep_until(opened_ + (ticks + 1) * refresh_period_);
  return hal::Flip{completed, ++flips_, completed};
}

void OffscreenDisplay::do_close() {
  surface_.reset();
  width_ = 0;
  height_ = 0;
  set_state(hal::DeviceState::absent);
}

} // namespace octascope::sim
