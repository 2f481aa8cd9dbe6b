// Time on command: it stands still until somebody sleeps or advances it.
#pragma once

#include <atomic>

#include "hal/clock.h"

namespace octascope::sim {

// Starts at 1 s, so that tests can look back without negative times. A sleep takes no real time:
// it moves the clock forward to its deadline, which makes single-threaded tests exact and fast.
// Thread-safe; with several sleepers, time is where the latest deadline was.
class VirtualClock final : public hal::Clock {
public:
  void advance(hal::Duration by) { now_ns_.fetch_add(by.count(), std::memory_order_acq_rel); }

private:
  hal::TimePoint do_now() const override {
    return hal::TimePoint{hal::Duration{now_ns_.load(std::memory_order_acquire)}};
  }
  void do_sleep_until(hal::TimePoint deadline) override;

  std::atomic<std::int64_t> now_ns_{1'000'000'000};
};

} // namespace octascope::sim
