#include "tests/support/pictures/virtual_screen.h"

#include <array>
#include <csignal>
#include <cstdlib>
#include <cstring>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

namespace octascope::tests {

namespace {

constexpr int start_limit_ms = 15'000;

// The display number that the server writes when it is ready; empty after the limit.
std::string read_number(int pipe_end) {
  std::string number;
  pollfd ready{pipe_end, POLLIN, 0};
  while (poll(&ready, 1, start_limit_ms) > 0) {
    char character = 0;
    if (read(pipe_end, &character, 1) != 1)
      return {};
    if (character == '\n')
      return number;
    number += character;
  }
  return {};
}

} // namespace

VirtualScreen::VirtualScreen() {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) {
    problem_ = "no pipe to Xvfb";
    return;
  }
  const std::string write_end = std::to_string(ends[1]);
  // Without -noreset it begins anew when its last window closes, and takes nobody in meanwhile.
  std::array<const char*, 10> words{"Xvfb",     "-displayfd",  write_end.c_str(), "-screen",
                                    "0",        "1280x800x24", "-nolisten",       "tcp",
                                    "-noreset", nullptr};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  const int error = posix_spawnp(&server_, "Xvfb", &actions, nullptr,
                                 const_cast<char* const*>(words.data()), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  if (error != 0) {
    server_ = 0;
    problem_ = std::string{"no Xvfb here: "} + std::strerror(error);
  } else if (const std::string number = read_number(ends[0]); !number.empty()) {
    setenv("DISPLAY", (":" + number).c_str(), 1);
    setenv("SDL_VIDEODRIVER", "x11", 1);
    unsetenv("WAYLAND_DISPLAY");
  } else {
    problem_ = "Xvfb does not come up";
    kill(server_, SIGTERM);
    waitpid(server_, nullptr, 0);
    server_ = 0;
  }
  close(ends[0]);
}

void VirtualScreen::end() {
  if (server_ <= 0)
    return;
  kill(server_, SIGTERM);
  waitpid(server_, nullptr, 0);
  server_ = 0;
  unsetenv("DISPLAY");
}

VirtualScreen::~VirtualScreen() {
  end();
}

} // namespace octascope::tests
