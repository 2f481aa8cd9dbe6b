#include "hal/linux/window_display.h"

#include <optional>

#include <GLES3/gl3.h>

#include "hal/linux/sdl_library.h"
#include "hal/linux/x11_connection.h"

namespace octascope::hal::linux_backend {

namespace {

constexpr std::uint16_t code(Key key) {
  return static_cast<std::uint16_t>(key);
}

// 0 for keys that mean nothing to us.
std::uint16_t key_of(SDL_Keycode key) {
  switch (key) {
  case SDLK_LEFT: return code(Key::left);
  case SDLK_RIGHT: return code(Key::right);
  case SDLK_UP: return code(Key::up);
  case SDLK_DOWN: return code(Key::down);
  case SDLK_PAGEUP: return code(Key::page_up);
  case SDLK_PAGEDOWN: return code(Key::page_down);
  case SDLK_HOME: return code(Key::home);
  case SDLK_END: return code(Key::end);
  case SDLK_TAB: return code(Key::tab);
  case SDLK_RETURN:
  case SDLK_KP_ENTER: return code(Key::enter);
  case SDLK_F1: return code(Key::f1);
  case SDLK_ESCAPE: return code(Key::escape);
  case SDLK_KP_PLUS: return '+';
  case SDLK_KP_MINUS: return '-';
  default: return key >= 32 && key < 127 ? static_cast<std::uint16_t>(key) : std::uint16_t{0};
  }
}

std::optional<DisplayEvent> translate(const SDL_Event& event, TimePoint time) {
  DisplayEvent result;
  result.time = time;
  switch (event.type) {
  case SDL_QUIT: result.kind = DisplayEventKind::close_requested; return result;
  case SDL_WINDOWEVENT:
    if (event.window.event != SDL_WINDOWEVENT_SIZE_CHANGED)
      return std::nullopt;
    result.kind = DisplayEventKind::resized;
    return result;
  case SDL_KEYDOWN:
  case SDL_KEYUP:
    result.kind =
        event.type == SDL_KEYDOWN ? DisplayEventKind::key_pressed : DisplayEventKind::key_released;
    result.key = key_of(event.key.keysym.sym);
    result.repeated = event.key.repeat != 0;
    result.shift = (event.key.keysym.mod & KMOD_SHIFT) != 0;
    if (result.key == 0)
      return std::nullopt;
    return result;
  default: return std::nullopt;
  }
}

} // namespace

namespace {

// SDL keeps the broken connection for the life of the program.
Error server_gone(ErrorCode code) {
  return {code, "window display: the X server has gone away, expected it to stay; the run goes on "
                "without a window: end it, and start it again when the server is back"};
}

} // namespace

struct WindowDisplay::Window {
  SdlLibrary sdl;
  SDL_Window* window = nullptr;
  SDL_GLContext context = nullptr;
  bool video = false;
  X11Connection server;
  SDL_Point last_size{0, 0};

  explicit Window(const SdlLibrary& loaded) : sdl{loaded} {}
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  ~Window() {
    server.talk([this] { // without a server SDL would wait for answers without end
      if (context != nullptr)
        sdl.gl_delete_context(context);
      if (window != nullptr)
        sdl.destroy_window(window);
      if (video)
        sdl.quit_sub_system(SDL_INIT_VIDEO);
    });
  }

  // Of a window that is gone, its last one.
  SDL_Point size() {
    server.talk([this] { sdl.gl_get_drawable_size(window, &last_size.x, &last_size.y); });
    return last_size;
  }

  tl::unexpected<Error> refuse(ErrorCode fault, std::string_view found,
                               std::string_view expected) const {
    return fail(fault, "window display: {} ({}), expected {}", found, sdl.get_error(), expected);
  }

  Result<> start_video() {
    // Signals are the host's: SDL would turn Ctrl-C into a window event.
    sdl.set_hint(SDL_HINT_NO_SIGNAL_HANDLERS, "1");
    sdl.set_hint(SDL_HINT_VIDEO_ALLOW_SCREENSAVER, "0");
    sdl.set_hint(SDL_HINT_VIDEO_X11_NET_WM_BYPASS_COMPOSITOR, "0");
    if (sdl.init_sub_system(SDL_INIT_VIDEO) != 0)
      return refuse(ErrorCode::absent, "no window system found",
                    "an X11 or Wayland display; set DISPLAY or WAYLAND_DISPLAY, or choose "
                    "--display offscreen");
    video = true;
    const std::string_view driver = sdl.get_current_video_driver();
    if (driver != "x11" && driver != "wayland")
      return fail(ErrorCode::absent,
                  "window display: SDL found only its driver \"{}\", expected an X11 or Wayland "
                  "display; set DISPLAY or WAYLAND_DISPLAY, or choose --display offscreen",
                  driver);
    return {};
  }

  Result<> make(const DisplayConfig& config) {
    sdl.gl_set_attribute(SDL_GL_CONTEXT_PROFILE_MASK, SDL_GL_CONTEXT_PROFILE_ES);
    sdl.gl_set_attribute(SDL_GL_CONTEXT_MAJOR_VERSION, 3);
    sdl.gl_set_attribute(SDL_GL_CONTEXT_MINOR_VERSION, 0);
    sdl.gl_set_attribute(SDL_GL_DOUBLEBUFFER, 1);
    sdl.gl_set_attribute(SDL_GL_DEPTH_SIZE, 0);
    Uint32 flags = SDL_WINDOW_OPENGL | SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI;
    if (config.fullscreen)
      flags |= SDL_WINDOW_FULLSCREEN_DESKTOP;
    window = sdl.create_window(config.title.c_str(), SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED,
                               config.width, config.height, flags);
    if (window == nullptr)
      return refuse(ErrorCode::unsupported, "no window for GLES could be made",
                    "a window system with EGL or GLX for GLES 3; install libegl1 and "
                    "libgl1-mesa-dri");
    server.watch(sdl, window);
    context = sdl.gl_create_context(window);
    if (context == nullptr)
      return refuse(ErrorCode::unsupported, "no GLES 3 context could be made",
                    "a driver with GLES 3; install libgl1-mesa-dri or choose --display offscreen");
    sdl.gl_set_swap_interval(1); // refused on some virtual outputs: present() paces then
    if (config.fullscreen)
      sdl.show_cursor(SDL_DISABLE);
    return {};
  }
};

WindowDisplay::WindowDisplay(Clock& clock) : clock_{clock} {}

WindowDisplay::~WindowDisplay() {
  do_close();
}

Result<> WindowDisplay::do_open(const DisplayConfig& config) {
  if (server_gone_)
    return tl::make_unexpected(server_gone(ErrorCode::absent));
  HAL_TRY(const auto sdl, SdlLibrary::load());
  auto window = std::make_unique<Window>(sdl);
  HAL_CHECK(window->start_video());
  HAL_CHECK(window->make(config));

  SDL_DisplayMode mode{};
  const bool known =
      sdl.get_window_display_mode(window->window, &mode) == 0 && mode.refresh_rate > 0;
  refresh_period_ = from_seconds(1.0 / (known ? mode.refresh_rate : config.refresh_hz));
  window_ = std::move(window);
  flips_ = 0;
  pacer_ = FlipPacer{refresh_period_, clock_.now()};
  set_state(DeviceState::ready);
  return {};
}

int WindowDisplay::do_width() const {
  return window_ != nullptr ? window_->size().x : 0;
}

int WindowDisplay::do_height() const {
  return window_ != nullptr ? window_->size().y : 0;
}

Result<Flip> WindowDisplay::do_present() {
  if (window_ == nullptr)
    return fail(ErrorCode::absent, "window display: not open; open() it first");
  const TimePoint submitted = clock_.now();
  const bool shown = window_->server.talk([this] {
    window_->sdl.gl_swap_window(window_->window);
    // A driver asks the server for the window's size when the next frame begins: here, then, and not
    // in the midst of drawing.
    std::array<std::uint8_t, 4> pixel{};
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glReadPixels(0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel.data());
  });
  if (!shown) {
    set_state(DeviceState::failed);
    return tl::make_unexpected(server_gone(ErrorCode::disconnected));
  }
  const TimePoint completed =
      pacer_.completed({.submitted = submitted, .stamp = std::nullopt, .received = clock_.now()});
  clock_.sleep_until(pacer_.next_allowed());
  return Flip{completed, ++flips_, submitted};
}

std::size_t WindowDisplay::do_poll_events(std::span<DisplayEvent> events) {
  if (window_ == nullptr)
    return 0;
  std::size_t count = 0;
  SDL_Event event;
  bool found = true;
  while (count < events.size() && found) {
    if (!window_->server.talk([&] { found = window_->sdl.poll_event(&event) != 0; })) {
      set_state(DeviceState::failed);
      break;
    }
    if (const auto translated = found ? translate(event, clock_.now()) : std::nullopt)
      events[count++] = *translated;
  }
  return count;
}

void WindowDisplay::do_close() {
  server_gone_ = server_gone_ || (window_ != nullptr && window_->server.is_lost());
  window_.reset();
  set_state(DeviceState::absent);
}

} // namespace octascope::hal::linux_backend
