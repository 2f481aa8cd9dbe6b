// What a device that was just plugged in has in /dev: there soon, not at once.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <thread>

#include <unistd.h>

namespace octascope::tests {

// Asks for the node's name ("" while the kernel knows none) until that file is there; false after 5
// s.
inline bool node_appears(const std::function<std::string()>& node) {
  for (int tries = 0; tries < 5000; ++tries) {
    const std::string name = node();
    if (!name.empty() && ::access(name.c_str(), F_OK) == 0)
      return true;
    std::this_thread::sleep_for(std::chrono::milliseconds{1});
  }
  return false;
}

} // namespace octascope::tests
