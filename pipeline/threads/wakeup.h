// Wakes one waiting thread; a wake-up that comes before the wait is not lost.
#pragma once

#include <semaphore.h>

#include "hal/clock.h"

namespace octascope::pipeline {

// A POSIX semaphore: posting is one atomic instruction while nobody waits, and a futex call
// otherwise; it neither locks nor allocates. Waiting is against CLOCK_MONOTONIC, the axis of
// hal::TimePoint.
class Wakeup {
public:
  Wakeup() { sem_init(&semaphore_, 0, 0); }
  ~Wakeup() { sem_destroy(&semaphore_); }
  Wakeup(const Wakeup&) = delete;
  Wakeup& operator=(const Wakeup&) = delete;

  // Any thread.
  void post() { sem_post(&semaphore_); }

  // Returns at a post, or at the deadline; true for a post. Takes all posts made so far.
  bool wait_until(hal::TimePoint deadline);
  // Returns at a post, and takes this one only.
  void wait();

private:
  sem_t semaphore_{};
};

} // namespace octascope::pipeline
