#include "hal/linux/sdl_library.h"

#include <dlfcn.h>

namespace octascope::hal::linux_backend {

namespace {

tl::unexpected<Error> refuse() {
  return fail(ErrorCode::unsupported,
              "window display: SDL 2 cannot be loaded ({}), expected its library; install it with "
              "`apt install libsdl2-2.0-0`, or choose --display kms or --display offscreen",
              ::dlerror());
}

template <class Function> bool find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(::dlsym(library, name));
  return function != nullptr;
}

bool find_all(void* library, SdlLibrary& sdl) {
  return find(library, "SDL_InitSubSystem", sdl.init_sub_system) &&
         find(library, "SDL_QuitSubSystem", sdl.quit_sub_system) &&
         find(library, "SDL_SetHint", sdl.set_hint) &&
         find(library, "SDL_GetError", sdl.get_error) &&
         find(library, "SDL_GetCurrentVideoDriver", sdl.get_current_video_driver) &&
         find(library, "SDL_CreateWindow", sdl.create_window) &&
         find(library, "SDL_DestroyWindow", sdl.destroy_window) &&
         find(library, "SDL_GetWindowDisplayMode", sdl.get_window_display_mode) &&
         find(library, "SDL_GetWindowWMInfo", sdl.get_window_wm_info) &&
         find(library, "SDL_ShowCursor", sdl.show_cursor) &&
         find(library, "SDL_PollEvent", sdl.poll_event) &&
         find(library, "SDL_GL_SetAttribute", sdl.gl_set_attribute) &&
         find(library, "SDL_GL_CreateContext", sdl.gl_create_context) &&
         find(library, "SDL_GL_DeleteContext", sdl.gl_delete_context) &&
         find(library, "SDL_GL_SetSwapInterval", sdl.gl_set_swap_interval) &&
         find(library, "SDL_GL_GetDrawableSize", sdl.gl_get_drawable_size) &&
         find(library, "SDL_GL_SwapWindow", sdl.gl_swap_window);
}

} // namespace

Result<SdlLibrary> SdlLibrary::load(const char* file) {
  void* const library = ::dlopen(file, RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
  if (library == nullptr)
    return refuse();
  SdlLibrary sdl;
  if (!find_all(library, sdl))
    return refuse();
  return sdl;
}

} // namespace octascope::hal::linux_backend
