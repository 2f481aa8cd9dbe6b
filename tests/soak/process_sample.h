// What a running process holds, from /proc.
#pragma once

#include <cstddef>
#include <optional>

#include <sys/types.h>

namespace octascope::tests {

struct ProcessSample {
  double at_s = 0; // set by who asks
  double resident_kib = 0;
  std::size_t descriptors = 0;
  std::size_t threads = 0;
};

// Empty when the process is gone.
std::optional<ProcessSample> sample_process(pid_t process);

} // namespace octascope::tests
