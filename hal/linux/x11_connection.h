// An X server that goes away ends every program that talks to it through Xlib, and SDL's own loops
// never end where Xlib is told to go on. So whoever has a window talks to the server through here.
#pragma once

#include <csetjmp>

#include "hal/linux/sdl_library.h"

namespace octascope::hal::linux_backend {

// Threads: all calls by the thread that made the window. Once watching, it must neither move nor end
// before the program does, unless the connection is closed first.
class X11Connection {
public:
  X11Connection() = default;
  X11Connection(const X11Connection&) = delete;
  X11Connection& operator=(const X11Connection&) = delete;

  // Does nothing for a window under Wayland, whose end SDL tells as an event.
  void watch(const SdlLibrary& sdl, SDL_Window* window);

  // Looks whether the server has gone away.
  bool is_lost();

  // Whether `call` came back with the server still there. It is not begun without a server, and is
  // left by longjmp if Xlib misses the server within it: C functions only, and no object that a
  // jump would leave undestroyed.
  template <class Call> bool talk(Call call) {
    if (is_lost())
      return false;
    // NOLINTNEXTLINE(cert-err52-cpp): through the C of Xlib and SDL there is no other way
    if (setjmp(before_call_) != 0)
      return false;
    talking_ = true;
    call();
    talking_ = false;
    return true;
  }

private:
  void leave_call();

  int socket_ = -1; // Xlib's
  bool lost_ = false;
  bool talking_ = false;
  std::jmp_buf before_call_{};
};

} // namespace octascope::hal::linux_backend
