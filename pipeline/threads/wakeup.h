// Wakes one waiting thread; a wake-up that comes before the wait is not lost.
#pragma once

#include "hal/clock.h"
#include "hal/semaphore.h"

namespace octascope::pipeline {

// Posting neither locks nor allocates (hal/semaphore.h).
class Wakeup {
public:
  // Any thread.
  void post() { semaphore_.post(); }

  // Returns at a post, or when it is `deadline` by `clock`; true for a post. Takes all posts made
  // so far.
  bool wait_until(hal::Clock& clock, hal::TimePoint deadline) {
    return clock.wait_until(semaphore_, deadline);
  }
  // Returns at a post, and takes this one only.
  void wait() { semaphore_.wait(); }

private:
  hal::Semaphore semaphore_;
};

} // namespace octascope::pipeline
