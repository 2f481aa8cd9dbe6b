// A clock that stands still until somebody sleeps or advances it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <vector>

#include "hal/clock.h"

namespace octascope::sim {

// Starts at 1 s, so that tests can look back without negative times. A sleep takes no real time: it
// moves the clock to its deadline, which makes single-threaded tests exact and fast. A wait for a
// post or a time moves nothing: it ends with the post, or when others have moved the clock to its
// deadline. Thread-safe; with several sleepers, the latest deadline counts.
class VirtualClock final : public hal::Clock {
public:
  void advance(hal::Duration by);

  // Returns as soon as a thread waits for a post or a time that has not come, with the earliest
  // such time. That thread has finished everything it was told to do before.
  hal::TimePoint await_waiter();

private:
  struct Waiter {
    hal::Semaphore& semaphore;
    hal::TimePoint deadline;
    bool due = false; // already posted by the clock
  };

  hal::TimePoint do_now() const override {
    return hal::TimePoint{hal::Duration{now_ns_.load(std::memory_order_acquire)}};
  }
  void do_sleep_until(hal::TimePoint deadline) override;
  bool do_wait_until(hal::Semaphore& semaphore, hal::TimePoint deadline) override;
  void move_to(hal::TimePoint time); // call with the mutex held

  std::atomic<std::int64_t> now_ns_{1'000'000'000};
  std::mutex mutex_; // of all that moves the clock, and of the waiters
  std::condition_variable waits_;
  std::vector<Waiter*> waiters_;
};

} // namespace octascope::sim
