// Time, injected: whatever waits or stamps takes a Clock, so that tests can own the time.
//
// All time points of the program are on one monotonic axis (CLOCK_MONOTONIC on Linux), the axis on
// which V4L2, GPIO and KMS stamp their events. Wall-clock time appears only in file names and logs.
#pragma once

#include <chrono>
#include <cstdint>

#include "hal/semaphore.h"

namespace octascope::hal {

struct MonotonicAxis {
  using rep = std::int64_t;
  using period = std::nano;
  using duration = std::chrono::nanoseconds;
  using time_point = std::chrono::time_point<MonotonicAxis>;
  static constexpr bool is_steady = true;
};

using Duration = MonotonicAxis::duration;
using TimePoint = MonotonicAxis::time_point;

constexpr double to_ms(Duration d) {
  return static_cast<double>(d.count()) * 1e-6;
}
constexpr double to_seconds(Duration d) {
  return static_cast<double>(d.count()) * 1e-9;
}
constexpr Duration from_seconds(double s) {
  return Duration{static_cast<std::int64_t>(s * 1e9 + (s < 0 ? -0.5 : 0.5))};
}

// Thread-safe: any thread may ask or sleep.
class Clock {
public:
  virtual ~Clock() = default;

  TimePoint now() const { return do_now(); }

  // Returns at or after `deadline`; at once when it has passed. Allocates nothing.
  void sleep_until(TimePoint deadline) { do_sleep_until(deadline); }
  void sleep_for(Duration duration) { do_sleep_until(do_now() + duration); }

  // Returns at a post of `semaphore`, or at or after `deadline`; true for a post. Takes all posts
  // made so far: whoever waits looks at everything that may have happened. One thread waits at a
  // semaphore; neither locks nor allocates on a real clock.
  bool wait_until(Semaphore& semaphore, TimePoint deadline) {
    return do_wait_until(semaphore, deadline);
  }

private:
  virtual TimePoint do_now() const = 0;
  virtual void do_sleep_until(TimePoint deadline) = 0;
  virtual bool do_wait_until(Semaphore& semaphore, TimePoint deadline) = 0;
};

} // namespace octascope::hal
