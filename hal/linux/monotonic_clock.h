// CLOCK_MONOTONIC, with absolute sleeps.
#pragma once

#include "hal/clock.h"

namespace octascope::hal::linux_backend {

class MonotonicClock final : public Clock {
private:
  TimePoint do_now() const override;
  void do_sleep_until(TimePoint deadline) override;
};

} // namespace octascope::hal::linux_backend
