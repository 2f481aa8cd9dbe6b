#include "hal/linux/x11_connection.h"

#include <SDL_syswm.h>
#include <poll.h>

namespace octascope::hal::linux_backend {

int x11_socket(const SdlLibrary& sdl, SDL_Window* window) {
  SDL_SysWMinfo info{};
  SDL_VERSION(&info.version);
  if (sdl.get_window_wm_info(window, &info) == SDL_FALSE || info.subsystem != SDL_SYSWM_X11)
    return -1;
  return ConnectionNumber(info.info.x11.display);
}

bool has_hung_up(int socket) {
  pollfd state{socket, POLLRDHUP, 0};
  return ::poll(&state, 1, 0) > 0 && (state.revents & (POLLRDHUP | POLLHUP | POLLERR)) != 0;
}

} // namespace octascope::hal::linux_backend
