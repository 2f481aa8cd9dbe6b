#include "sim/clock/virtual_clock.h"

#include <algorithm>

namespace octascope::sim {

void VirtualClock::advance(hal::Duration by) {
  const std::lock_guard lock{mutex_};
  move_to(do_now() + by);
}

hal::TimePoint VirtualClock::await_waiter() {
  hal::TimePoint earliest;
  std::unique_lock lock{mutex_};
  waits_.wait(lock, [&] {
    earliest = hal::TimePoint::max();
    for (const Waiter* const waiter : waiters_) {
      if (!waiter->due)
        earliest = std::min(earliest, waiter->deadline);
    }
    return earliest != hal::TimePoint::max();
  });
  return earliest;
}

void VirtualClock::do_sleep_until(hal::TimePoint deadline) {
  const std::lock_guard lock{mutex_};
  if (deadline > do_now())
    move_to(deadline);
}

bool VirtualClock::do_wait_until(hal::Semaphore& semaphore, hal::TimePoint deadline) {
  Waiter waiter{semaphore, deadline};
  {
    const std::lock_guard lock{mutex_};
    if (semaphore.take_all() > 0)
      return true;
    if (deadline <= do_now())
      return false;
    waiters_.push_back(&waiter);
  }
  waits_.notify_all();
  semaphore.wait();
  {
    const std::lock_guard lock{mutex_};
    std::erase(waiters_, &waiter);
  }
  const int posts = 1 + semaphore.take_all();
  return posts > (waiter.due ? 1 : 0);
}

void VirtualClock::move_to(hal::TimePoint time) {
  now_ns_.store(time.time_since_epoch().count(), std::memory_order_release);
  for (Waiter* const waiter : waiters_) {
    if (!waiter->due && waiter->deadline <= time) {
      waiter->due = true;
      waiter->semaphore.post();
    }
  }
}

} // namespace octascope::sim
