#include "pipeline/threads/wakeup.h"

#include <cerrno>
#include <ctime>

namespace octascope::pipeline {

bool Wakeup::wait_until(hal::TimePoint deadline) {
  constexpr std::int64_t ns_per_s = 1'000'000'000;
  const std::int64_t ns = deadline.time_since_epoch().count();
  const timespec t{.tv_sec = ns / ns_per_s, .tv_nsec = ns % ns_per_s};
  int result = 0;
  do
    result = sem_clockwait(&semaphore_, CLOCK_MONOTONIC, &t);
  while (result != 0 && errno == EINTR);
  if (result != 0)
    return false;
  // Whoever waits looks at everything that may have happened, so posts in a row are one.
  while (sem_trywait(&semaphore_) == 0) {
  }
  return true;
}

void Wakeup::wait() {
  while (sem_wait(&semaphore_) != 0 && errno == EINTR) {
  }
}

} // namespace octascope::pipeline
