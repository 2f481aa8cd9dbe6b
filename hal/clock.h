// Injected time: code that waits or takes time stamps is given a Clock, so that tests can control
// time.
//
// All time points are on one monotonic axis (CLOCK_MONOTONIC on Linux), which V4L2, GPIO and KMS
// also use for their events. Wall-clock time appears only in file names and logs.
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

// now + timeout, without overflow.
constexpr TimePoint deadline_after(TimePoint now, Duration timeout) {
  return timeout > TimePoint::max() - now ? TimePoint::max() : now + timeout;
}

// Thread-safe.
class Clock {
public:
  virtual ~Clock() = default;

  TimePoint now() const { return do_now(); }

  // Returns at or after `deadline`, immediately if it has passed. Does not allocate.
  void sleep_until(TimePoint deadline) { do_sleep_until(deadline); }
  void sleep_for(Duration duration) { do_sleep_until(do_now() + duration); }

  // Waits for a post of `semaphore` until `deadline`; true for a post, false for a timeout. Takes
  // all posts made so far, so the caller must check everything that may have been posted. Only one
  // thread may wait on a semaphore. On a real clock it neither locks nor allocates.
  bool wait_until(Semaphore& semaphore, TimePoint deadline) {
    return do_wait_until(semaphore, deadline);
  }

private:
  virtual TimePoint do_now() const = 0;
  virtual void do_sleep_until(TimePoint deadline) = 0;
  virtual bool do_wait_until(Semaphore& semaphore, TimePoint deadline) = 0;
};

} // namespace octascope::hal
