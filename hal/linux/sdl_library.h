// SDL2's functions, loaded only when a window is requested: an appliance on the console needs
// neither SDL nor the thirty sound and desktop libraries it depends on.
#pragma once

#include <SDL.h>

struct SDL_SysWMinfo;

#include "hal/result.h"

namespace octascope::hal::linux_backend {

// Copyable: the library stays loaded until the program ends, because neither SDL nor the GL drivers
// it loads can be unloaded safely. Threads: as for SDL.
struct SdlLibrary {
  // ErrorCode::unsupported: `file` is not installed or is not SDL2.
  static Result<SdlLibrary> load(const char* file = "libSDL2-2.0.so.0");

  decltype(&SDL_InitSubSystem) init_sub_system = nullptr;
  decltype(&SDL_QuitSubSystem) quit_sub_system = nullptr;
  decltype(&SDL_SetHint) set_hint = nullptr;
  decltype(&SDL_GetError) get_error = nullptr;
  decltype(&SDL_GetCurrentVideoDriver) get_current_video_driver = nullptr;
  decltype(&SDL_CreateWindow) create_window = nullptr;
  decltype(&SDL_DestroyWindow) destroy_window = nullptr;
  decltype(&SDL_GetWindowDisplayMode) get_window_display_mode = nullptr;
  SDL_bool (*get_window_wm_info)(SDL_Window*, SDL_SysWMinfo*) = nullptr;
  decltype(&SDL_ShowCursor) show_cursor = nullptr;
  decltype(&SDL_PollEvent) poll_event = nullptr;
  decltype(&SDL_GL_SetAttribute) gl_set_attribute = nullptr;
  decltype(&SDL_GL_CreateContext) gl_create_context = nullptr;
  decltype(&SDL_GL_DeleteContext) gl_delete_context = nullptr;
  decltype(&SDL_GL_SetSwapInterval) gl_set_swap_interval = nullptr;
  decltype(&SDL_GL_GetDrawableSize) gl_get_drawable_size = nullptr;
  decltype(&SDL_GL_SwapWindow) gl_swap_window = nullptr;
};

} // namespace octascope::hal::linux_backend
