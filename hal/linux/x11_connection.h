// An X server that goes away ends, by Xlib's default, every program with a window on it.
#pragma once

#include <atomic>

#include "hal/linux/sdl_library.h"

namespace octascope::hal::linux_backend {

// From now on `lost` is set instead, which must outlive the window's connection. Does nothing for a
// window under Wayland, or with an Xlib before 1.7, which cannot be told.
void survive_lost_x_server(const SdlLibrary& sdl, SDL_Window* window, std::atomic<bool>& lost);

} // namespace octascope::hal::linux_backend
