// Wakes a thread that waits; a post that comes before the wait is not lost.
#pragma once

#include <semaphore.h>

namespace octascope::hal {

// A POSIX semaphore: posting is one atomic instruction while nobody waits, and a futex call
// otherwise; it neither locks nor allocates. To wait for a post until some time, ask the clock
// that the time is of: Clock::wait_until().
class Semaphore {
public:
  Semaphore() { sem_init(&semaphore_, 0, 0); }
  ~Semaphore() { sem_destroy(&semaphore_); }
  Semaphore(const Semaphore&) = delete;
  Semaphore& operator=(const Semaphore&) = delete;

  // Any thread.
  void post() { sem_post(&semaphore_); }

  // Returns at a post, and takes this one only.
  void wait() {
    while (sem_wait(&semaphore_) != 0) { // a signal came
    }
  }

  // Takes all posts made so far, and tells how many they were. Does not wait.
  int take_all() {
    int count = 0;
    while (sem_trywait(&semaphore_) == 0)
      ++count;
    return count;
  }

  // For clocks.
  sem_t& native() { return semaphore_; }

private:
  sem_t semaphore_{};
};

} // namespace octascope::hal
