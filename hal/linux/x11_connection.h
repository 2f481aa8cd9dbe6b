// An X server that goes away ends every program that then calls Xlib, and SDL's own loops do not end
// where Xlib is told otherwise. So whoever has a window looks before each such call.
#pragma once

#include "hal/linux/sdl_library.h"

namespace octascope::hal::linux_backend {

// The socket of the window's connection; −1 for a window under Wayland, whose end SDL tells as an
// event. It belongs to Xlib.
int x11_socket(const SdlLibrary& sdl, SDL_Window* window);

// Whether the server at the other end has gone away. Never for −1.
bool has_hung_up(int socket);

} // namespace octascope::hal::linux_backend
