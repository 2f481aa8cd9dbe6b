#include "hal/linux/x11_connection.h"

#include <SDL_syswm.h>
#include <dlfcn.h>

namespace octascope::hal::linux_backend {

namespace {

// Xlib's calls on that connection return without effect after this has returned.
void note_loss(::Display* /*connection*/, void* lost) {
  static_cast<std::atomic<bool>*>(lost)->store(true, std::memory_order_relaxed);
}

} // namespace

void survive_lost_x_server(const SdlLibrary& sdl, SDL_Window* window, std::atomic<bool>& lost) {
  SDL_SysWMinfo info{};
  SDL_VERSION(&info.version);
  if (sdl.get_window_wm_info(window, &info) == SDL_FALSE || info.subsystem != SDL_SYSWM_X11)
    return;
  // SDL has loaded it: the program itself is not linked with it.
  void* const xlib = ::dlopen("libX11.so.6", RTLD_NOW | RTLD_NOLOAD);
  if (xlib == nullptr)
    return;
  using SetHandler = void (*)(::Display*, void (*)(::Display*, void*), void*);
  if (const auto set = reinterpret_cast<SetHandler>(::dlsym(xlib, "XSetIOErrorExitHandler")))
    set(info.info.x11.display, note_loss, &lost);
  ::dlclose(xlib); // what SDL holds stays
}

} // namespace octascope::hal::linux_backend
