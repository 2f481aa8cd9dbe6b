#include "firmware-host/run/process_start.h"

#include <algorithm>
#include <charconv>
#include <ctime>
#include <fstream>
#include <string>
#include <string_view>

#include <unistd.h>

namespace octascope::firmware_host {

namespace {

// Field 22 of proc_pid_stat(5): ticks since the system was booted. The second field, the program's
// name in brackets, may hold anything, brackets and spaces included: counting begins behind it.
double start_s_after_boot() {
  std::string stat;
  std::getline(std::ifstream{"/proc/self/stat"}, stat);
  std::string_view rest = stat;
  rest.remove_prefix(std::min(rest.rfind(')') + 1, rest.size()));
  constexpr int fields_before = 20;
  for (int i = 0; i < fields_before; ++i)
    rest.remove_prefix(std::min(rest.find(' ') + 1, rest.size()));
  long long ticks = -1;
  std::from_chars(rest.data(), rest.data() + rest.size(), ticks);
  return static_cast<double>(ticks) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

double now_s_after_boot() {
  std::timespec now{};
  ::clock_gettime(CLOCK_BOOTTIME, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

} // namespace

hal::TimePoint process_start(const hal::Clock& clock) {
  const double start = start_s_after_boot();
  if (start < 0)
    return clock.now();
  return clock.now() - hal::from_seconds(now_s_after_boot() - start);
}

} // namespace octascope::firmware_host
