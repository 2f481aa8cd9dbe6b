// An X server without a screen (Xvfb), for tests of what needs a window system.
#pragma once

#include <string>

#include <sys/types.h>

namespace octascope::tests {

// Runs for the life of the object; DISPLAY names it meanwhile, and no other window system is found.
class VirtualScreen {
public:
  VirtualScreen();
  VirtualScreen(const VirtualScreen&) = delete;
  VirtualScreen& operator=(const VirtualScreen&) = delete;
  ~VirtualScreen();

  // As when it crashes, or its user logs out. Does nothing if it does not run.
  void end();

  bool running() const { return server_ > 0; }
  // "not running: …" otherwise.
  const std::string& problem() const { return problem_; }

private:
  pid_t server_ = 0;
  std::string problem_;
};

} // namespace octascope::tests
