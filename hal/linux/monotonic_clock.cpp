#include "hal/linux/monotonic_clock.h"

#include <cerrno>
#include <ctime>

namespace octascope::hal::linux_backend {

namespace {
constexpr std::int64_t ns_per_s = 1'000'000'000;
}

TimePoint MonotonicClock::do_now() const {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return TimePoint{Duration{t.tv_sec * ns_per_s + t.tv_nsec}};
}

void MonotonicClock::do_sleep_until(TimePoint deadline) {
  const std::int64_t ns = deadline.time_since_epoch().count();
  if (ns <= 0)
    return;
  const timespec t{.tv_sec = ns / ns_per_s, .tv_nsec = ns % ns_per_s};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

} // namespace octascope::hal::linux_backend
