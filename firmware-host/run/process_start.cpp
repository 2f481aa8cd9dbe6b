#include "firmware-host/run/process_start.h"

#include <algorithm>
#include <ctime>
#include <string>
#include <string_view>

#include <unistd.h>

#include "hal/linux/system/system_files.h"
#include "hal/number_text.h"

namespace octascope::firmware_host {

namespace {

// Field 22 of proc_pid_stat(5): ticks since the system was booted. The second field, the program's
// name in brackets, may hold anything, brackets and spaces included: counting begins behind it.
double start_s_after_boot() {
  const std::string stat = hal::linux_backend::first_line("/proc/self/stat");
  std::string_view rest = stat;
  rest.remove_prefix(std::min(rest.rfind(')') + 1, rest.size()));
  constexpr int fields_before = 20;
  for (int i = 0; i < fields_before; ++i)
    rest.remove_prefix(std::min(rest.find(' ') + 1, rest.size()));
  const auto ticks = hal::take_number<long long>(rest).value_or(-1);
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
