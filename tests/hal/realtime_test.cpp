// Real-time threads that never wait. They need real-time priority, which not every user has.
#include <atomic>
#include <chrono>
#include <thread>

#include <gtest/gtest.h>
#include <sched.h>

#include "hal/linux/realtime.h"

namespace octascope::hal::linux_backend {
namespace {

using namespace std::chrono_literals;
using SteadyClock = std::chrono::steady_clock;

// Computes until `done` or for so long; returns the policy it ends with.
int compute_in_real_time(const std::atomic<bool>* done, SteadyClock::duration most,
                         std::atomic<bool>* waits) {
  int policy = -1;
  std::thread{[&] {
    if (waits != nullptr)
      expect_waits(*waits);
    if (!make_this_thread_realtime(1))
      return;
    const auto end = SteadyClock::now() + most;
    while (SteadyClock::now() < end && (done == nullptr || !done->load())) {
    }
    policy = sched_getscheduler(0);
  }}.join();
  return policy;
}

class Runaways : public testing::Test {
protected:
  void SetUp() override {
    if (compute_in_real_time(nullptr, 0ms, nullptr) != SCHED_FIFO)
      GTEST_SKIP() << "no real-time priority for this user";
    ASSERT_TRUE(demote_runaways(200ms));
  }
};

TEST_F(Runaways, lose_their_priority_and_are_told) {
  std::atomic<bool> demoted{false};
  EXPECT_EQ(compute_in_real_time(&demoted, 30s, &demoted), SCHED_OTHER);
  EXPECT_TRUE(demoted.load());
}

TEST_F(Runaways, are_not_those_that_have_much_to_do) {
  EXPECT_EQ(compute_in_real_time(nullptr, 1500ms, nullptr), SCHED_FIFO);
}

TEST_F(Runaways, are_not_those_that_wait_in_between) {
  std::atomic<bool> demoted{false};
  int policy = -1;
  std::thread{[&] {
    expect_waits(demoted);
    ASSERT_TRUE(make_this_thread_realtime(1));
    for (int step = 0; step < 20; ++step) {
      const auto end = SteadyClock::now() + 20ms;
      while (SteadyClock::now() < end) {
      }
      std::this_thread::sleep_for(1ms);
    }
    policy = sched_getscheduler(0);
  }}.join();
  EXPECT_EQ(policy, SCHED_FIFO);
  EXPECT_FALSE(demoted.load());
}

} // namespace
} // namespace octascope::hal::linux_backend
