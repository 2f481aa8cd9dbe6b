// A Clock on CLOCK_MONOTONIC, with absolute sleeps and waits.
#pragma once

#include "hal/clock.h"

namespace octascope::hal::linux_backend {

class MonotonicClock final : public Clock {
private:
  TimePoint do_now() const override;
  void do_sleep_until(TimePoint deadline) override;
  bool do_wait_until(Semaphore& semaphore, TimePoint deadline) override;
};

} // namespace octascope::hal::linux_backend
