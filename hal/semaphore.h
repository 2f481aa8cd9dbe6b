// Wakes a waiting thread; a post made before the wait is not lost.
#pragma once

#include <semaphore.h>

namespace octascope::hal {

// A POSIX semaphore: a post is one atomic instruction while no thread waits, a futex call
// otherwise; it neither locks nor allocates. To wait with a deadline, use Clock::wait_until().
class Semaphore {
public:
  Semaphore() { sem_init(&semaphore_, 0, 0); }
  ~Semaphore() { sem_destroy(&semaphore_); }
  Semaphore(const Semaphore&) = delete;
  Semaphore& operator=(const Semaphore&) = delete;

  // Any thread.
  void post() { sem_post(&semaphore_); }

  // Waits for one post and takes it.
  void wait() {
    while (sem_wait(&semaphore_) != 0) { // interrupted by a signal
    }
  }

  // Takes all posts made so far and returns their number. Does not wait.
  int take_all() {
    int count = 0;
    while (sem_trywait(&semaphore_) == 0)
      ++count;
    return count;
  }

  // For implementations of Clock.
  sem_t& native() { return semaphore_; }

private:
  sem_t semaphore_{};
};

} // namespace octascope::hal
