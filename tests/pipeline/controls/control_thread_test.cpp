#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/controls/control_thread.h"

namespace octascope::pipeline {
namespace {

using namespace std::chrono_literals;

// Time stands still; whoever sleeps does so for a moment.
class StillClock final : public hal::Clock {
  hal::TimePoint do_now() const override { return hal::TimePoint{2s}; }
  void do_sleep_until(hal::TimePoint) override { std::this_thread::sleep_for(1ms); }
  bool do_wait_until(hal::Semaphore& semaphore, hal::TimePoint) override {
    return semaphore.take_all() > 0;
  }
};

// A puck that is pushed, and pulled out meanwhile.
class LostPuck final : public hal::ControlInput {
  std::string_view do_backend() const override { return "fake"; }
  bool do_simulated() const override { return true; }
  hal::Result<> do_open() override {
    if (gone_)
      return hal::fail(hal::ErrorCode::absent, "pulled out");
    set_state(hal::DeviceState::ready);
    return {};
  }
  hal::Result<std::size_t> do_read(std::span<hal::ControlEvent> events, hal::Duration) override {
    if (told_) {
      gone_ = true;
      set_state(hal::DeviceState::failed);
      return hal::fail(hal::ErrorCode::disconnected, "pulled out");
    }
    told_ = true;
    const hal::TimePoint time{1s};
    events[0] = {time, hal::ControlKind::axis, 5, 700};
    events[1] = {time, hal::ControlKind::axis, 5, 0};
    return 2;
  }
  void do_close() override { set_state(hal::DeviceState::absent); }

  bool told_ = false;
  bool gone_ = false;
};

TEST(ControlThread, hands_on_the_last_of_a_lost_device_and_tells_that_it_is_lost) {
  LostPuck puck;
  StillClock clock;
  FaultLog faults;
  Wakeup news;
  ControlThread thread{puck, clock, faults, news};
  thread.start({});
  std::vector<hal::ControlEvent> events;
  const auto give_up = std::chrono::steady_clock::now() + 30s;
  while ((events.size() < 2 || faults.records().empty()) &&
         std::chrono::steady_clock::now() < give_up) {
    if (const auto event = thread.take())
      events.push_back(*event);
    else
      std::this_thread::sleep_for(1ms);
  }
  thread.stop();
  while (const auto event = thread.take())
    events.push_back(*event);
  ASSERT_EQ(events.size(), 2U);
  EXPECT_EQ(events[1].index, 5);
  EXPECT_EQ(events[1].value, 0);
  ASSERT_FALSE(faults.records().empty());
  EXPECT_EQ(faults.records()[0].kind,
            fault_of(Device::control_input, hal::ErrorCode::disconnected));
}

} // namespace
} // namespace octascope::pipeline
