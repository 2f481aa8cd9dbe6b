#include <thread>

#include <gtest/gtest.h>

#include "sim/clock/virtual_clock.h"

namespace octascope::sim {
namespace {

TEST(VirtualClock, sleeping_moves_time_and_past_deadlines_do_not) {
  VirtualClock clock;
  const hal::TimePoint start = clock.now();
  clock.sleep_for(std::chrono::hours{1});
  EXPECT_EQ(clock.now() - start, std::chrono::hours{1});
  clock.sleep_until(start);
  EXPECT_EQ(clock.now() - start, std::chrono::hours{1});
}

TEST(VirtualClock, who_waits_moves_no_time_and_is_woken_when_it_has_come) {
  VirtualClock clock;
  hal::Semaphore semaphore;
  const hal::TimePoint deadline = clock.now() + std::chrono::hours{1};
  bool posted = true;
  std::thread waiter{[&] { posted = clock.wait_until(semaphore, deadline); }};
  EXPECT_EQ(clock.await_waiter(), deadline);
  EXPECT_LT(clock.now(), deadline);
  clock.advance(std::chrono::hours{1} - hal::Duration{1});
  EXPECT_EQ(clock.await_waiter(), deadline) << "not yet";
  clock.advance(hal::Duration{1});
  waiter.join();
  EXPECT_FALSE(posted);
  EXPECT_EQ(semaphore.take_all(), 0) << "what woke it is not left behind";
}

TEST(VirtualClock, of_several_that_wait_the_earliest_is_told) {
  VirtualClock clock;
  hal::Semaphore first, second;
  const hal::TimePoint start = clock.now();
  std::thread late{[&] { clock.wait_until(second, start + std::chrono::seconds{2}); }};
  EXPECT_EQ(clock.await_waiter(), start + std::chrono::seconds{2});
  std::thread early{[&] { clock.wait_until(first, start + std::chrono::seconds{1}); }};
  while (clock.await_waiter() != start + std::chrono::seconds{1})
    std::this_thread::yield();
  clock.sleep_until(start + std::chrono::seconds{1});
  early.join();
  EXPECT_EQ(clock.await_waiter(), start + std::chrono::seconds{2});
  second.post();
  late.join();
}

} // namespace
} // namespace octascope::sim
