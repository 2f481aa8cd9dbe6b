#include "hal/linux/monotonic_clock.h"

#include <algorithm>
#include <cerrno>
#include <ctime>

namespace octascope::hal::linux_backend {

namespace {
constexpr std::int64_t ns_per_s = 1'000'000'000;

timespec to_timespec(TimePoint time) {
  const std::int64_t ns = time.time_since_epoch().count();
  return {.tv_sec = ns / ns_per_s, .tv_nsec = ns % ns_per_s};
}
} // namespace

TimePoint MonotonicClock::do_now() const {
  timespec t{};
  clock_gettime(CLOCK_MONOTONIC, &t);
  return TimePoint{Duration{t.tv_sec * ns_per_s + t.tv_nsec}};
}

void MonotonicClock::do_sleep_until(TimePoint deadline) {
  if (deadline <= TimePoint{})
    return;
  const timespec t = to_timespec(deadline);
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {
  }
}

bool MonotonicClock::do_wait_until(Semaphore& semaphore, TimePoint deadline) {
  const timespec t = to_timespec(std::max(deadline, TimePoint{}));
  int result = 0;
  do
    result = sem_clockwait(&semaphore.native(), CLOCK_MONOTONIC, &t);
  while (result != 0 && errno == EINTR);
  if (result != 0)
    return false;
  semaphore.take_all();
  return true;
}

} // namespace octascope::hal::linux_backend
