// A simulated chip with a trigger and a sync line, and somebody who watches the trigger's level.
#pragma once

#include <atomic>
#include <memory>

#include <gtest/gtest.h>

#include "hal/linux/gpio/gpio_galvo_trigger.h"
#include "hal/linux/monotonic_clock.h"
#include "tests/virtual_hardware/support/sim_gpio_chip.h"

namespace octascope::tests {

inline constexpr unsigned trigger_line = 3, sync_line = 5;

// Lines 3 and 5 of six are named octascope-trigger and octascope-sync.
std::unique_ptr<SimGpioChip> make_trigger_chip();

// A pulse of 50 µs is gone before another process has looked. But the trigger asks for the time
// around every change of level and sleeps while the line is high: this clock looks at the line
// each time, so it sees every level there is, and counts the edges between them.
class WatchingClock final : public hal::Clock {
public:
  explicit WatchingClock(const SimGpioChip& chip) : chip_(chip) {}
  std::uint64_t rising_edges() const {
    look();
    return rising_edges_.load();
  }

private:
  hal::TimePoint do_now() const override {
    look();
    return clock_.now();
  }
  void do_sleep_until(hal::TimePoint deadline) override {
    look();
    clock_.sleep_until(deadline);
    look();
  }
  bool do_wait_until(hal::Semaphore& semaphore, hal::TimePoint deadline) override {
    return clock_.wait_until(semaphore, deadline);
  }
  void look() const {
    const bool high = chip_.level(trigger_line);
    if (high && !was_high_.exchange(high))
      ++rising_edges_;
    was_high_ = high;
  }

  const SimGpioChip& chip_;
  hal::linux_backend::MonotonicClock clock_;
  mutable std::atomic<bool> was_high_{false};
  mutable std::atomic<std::uint64_t> rising_edges_{0};
};

// Skips where the kernel has no gpio-sim.
class GpioTest : public testing::Test {
protected:
  void SetUp() override;

  // Waits until the trigger line is so; false when it is not within 10 s.
  bool await_level(bool high);

  hal::linux_backend::MonotonicClock clock_;
  std::unique_ptr<SimGpioChip> chip_;
};

} // namespace octascope::tests
