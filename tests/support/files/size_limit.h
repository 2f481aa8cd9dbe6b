// No file grows beyond this from here on, in this process: writes fail as on a disk that is gone.
#pragma once

#include <csignal>
#include <cstdint>

#include <sys/resource.h>

namespace octascope::tests {

inline void limit_file_sizes(std::uintmax_t bytes) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{bytes, RLIM_INFINITY};
  ::setrlimit(RLIMIT_FSIZE, &limit);
}

} // namespace octascope::tests
