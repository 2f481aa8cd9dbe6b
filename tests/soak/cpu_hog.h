// Takes all processors from the program now and then, as the host of a virtual machine does.
#pragma once

#include <chrono>
#include <thread>
#include <vector>

namespace octascope::tests {

// From construction to destruction: about once a second, at times drawn from `seed`, each processor
// that this process may use does nothing but count for `each`, at the highest real-time priority,
// all at once.
class CpuHog {
public:
  CpuHog(std::chrono::duration<double> each, unsigned seed);

  // Whether the system lets this process have that priority.
  static bool is_permitted();

private:
  std::vector<std::jthread> threads_;
};

} // namespace octascope::tests
