// If the X server goes away, the next call of Xlib ends the program; and if Xlib is told not to,
// SDL's loops never return. So the window checks the connection before each such call.
#pragma once

#include "hal/linux/sdl_library.h"

namespace octascope::hal::linux_backend {

// The socket of the window's connection, which belongs to Xlib. −1 under Wayland, where SDL reports
// the end of the connection as an event.
int x11_socket(const SdlLibrary& sdl, SDL_Window* window);

// Whether the server has closed the connection; false for −1.
bool has_hung_up(int socket);

} // namespace octascope::hal::linux_backend
