// A clock that moves only when a thread sleeps or advances it.
#pragma once

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <vector>

#include "hal/clock.h"

namespace octascope::sim {

// Starts at 1 s, so that tests can look back without negative times. A sleep takes no real time: it
// moves the clock forward to its deadline, which makes single-threaded tests exact and fast.
// Waiting for a post or a time does not move the clock: the waiter is woken by the post, or when
// others have moved the clock to its deadline. Thread-safe; with several sleepers, the time is the
// latest deadline.
class VirtualClock final : public hal::Clock {
public:
  void advance(hal::Duration by);

  // Returns once a thread waits for a post or for a future time: the earliest such time. That
  // thread has then finished all earlier work.
  hal::TimePoint await_waiter();

private:
  struct Waiter {
    hal::Semaphore& semaphore;
    hal::TimePoint deadline;
    bool due = false; // the clock has posted
  };

  hal::TimePoint do_now() const override {
    return hal::TimePoint{hal::Duration{now_ns_.load(std::memory_order_acquire)}};
  }
  void do_sleep_until(hal::TimePoint deadline) override;
  bool do_wait_until(hal::Semaphore& semaphore, hal::TimePoint deadline) override;
  void move_to(hal::TimePoint time); // the mutex must be held

  std::atomic<std::int64_t> now_ns_{1'000'000'000};
  std::mutex mutex_; // guards changes of the clock, and the waiters
  std::condition_variable waits_;
  std::vector<Waiter*> waiters_;
};

} // namespace octascope::sim
