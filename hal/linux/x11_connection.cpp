#include "hal/linux/x11_connection.h"

#include <utility>

#include <SDL_syswm.h>
#include <dlfcn.h>
#include <poll.h>

namespace octascope::hal::linux_backend {

void X11Connection::watch(const SdlLibrary& sdl, SDL_Window* window) {
  SDL_SysWMinfo info{};
  SDL_VERSION(&info.version);
  if (sdl.get_window_wm_info(window, &info) == SDL_FALSE || info.subsystem != SDL_SYSWM_X11)
    return;
  socket_ = ConnectionNumber(info.info.x11.display);
  void* const xlib = ::dlopen("libX11.so.6", RTLD_NOW | RTLD_NOLOAD); // SDL has loaded it
  if (xlib == nullptr)
    return;
  const auto set_handler =
      reinterpret_cast<decltype(&XSetIOErrorHandler)>(::dlsym(xlib, "XSetIOErrorHandler"));
  const auto set_exit_handler =
      reinterpret_cast<decltype(&XSetIOErrorExitHandler)>(::dlsym(xlib, "XSetIOErrorExitHandler"));
  if (set_handler != nullptr && set_exit_handler != nullptr) {
    set_handler([](Display*) { return 0; }); // Xlib's own ends the program
    set_exit_handler(
        info.info.x11.display,
        [](Display*, void* connection) { static_cast<X11Connection*>(connection)->leave_call(); },
        this);
  }
  ::dlclose(xlib);
}

bool X11Connection::is_lost() {
  pollfd state{socket_, POLLRDHUP, 0};
  lost_ =
      lost_ || (::poll(&state, 1, 0) > 0 && (state.revents & (POLLRDHUP | POLLHUP | POLLERR)) != 0);
  return lost_;
}

void X11Connection::leave_call() {
  lost_ = true;
  if (std::exchange(talking_, false))
    std::longjmp(before_call_, 1);
}

} // namespace octascope::hal::linux_backend
