// What every hal::Clock must do. Include it in a test file and instantiate ClockContract with the
// clocks to test.
#pragma once

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "hal/clock.h"
#include "tests/contract/contract_case.h"
#include "tests/support/allocation_counter.h"

namespace octascope::tests {

using ClockCase = ContractCase<hal::Clock>;

class ClockContract : public testing::TestWithParam<ClockCase> {
protected:
  std::unique_ptr<hal::Clock> clock_ = GetParam().make();
};

TEST_P(ClockContract, time_never_runs_backwards) {
  hal::TimePoint last = clock_->now();
  for (int i = 0; i < 1000; ++i) {
    const hal::TimePoint now = clock_->now();
    ASSERT_GE(now, last);
    last = now;
  }
}

TEST_P(ClockContract, a_sleep_ends_at_or_after_its_deadline) {
  for (const std::int64_t us : {0, 1, 100, 2000}) {
    const hal::TimePoint deadline = clock_->now() + std::chrono::microseconds{us};
    clock_->sleep_until(deadline);
    EXPECT_GE(clock_->now(), deadline);
    const hal::TimePoint before = clock_->now();
    clock_->sleep_for(std::chrono::microseconds{us});
    EXPECT_GE(clock_->now() - before, std::chrono::microseconds{us});
  }
}

// A clock that slept for the hour (or until a wrapped-around date) would run into CTest's limit.
TEST_P(ClockContract, passed_deadlines_return_at_once) {
  clock_->sleep_until(clock_->now() - std::chrono::hours{1});
  clock_->sleep_until(hal::TimePoint{});
  clock_->sleep_until(hal::TimePoint{hal::Duration{-1}});
  clock_->sleep_until(hal::TimePoint::min());
  clock_->sleep_for(std::chrono::hours{-1});
}

TEST_P(ClockContract, sleeping_allocates_nothing) {
  const std::uint64_t before = allocations_of_this_thread();
  clock_->sleep_for(std::chrono::microseconds{100});
  clock_->now();
  EXPECT_EQ(allocations_of_this_thread(), before);
}

TEST_P(ClockContract, any_thread_may_ask_and_sleep) {
  std::vector<std::thread> threads;
  std::vector<int> early(4);
  for (int& missed : early) {
    threads.emplace_back([this, &missed] {
      for (int i = 0; i < 20; ++i) {
        const hal::TimePoint deadline = clock_->now() + std::chrono::microseconds{50};
        clock_->sleep_until(deadline);
        missed += clock_->now() < deadline;
      }
    });
  }
  for (std::thread& thread : threads)
    thread.join();
  EXPECT_EQ(early, std::vector<int>(4, 0));
}

TEST_P(ClockContract, a_post_before_the_wait_is_not_lost_and_all_are_taken) {
  hal::Semaphore semaphore;
  const hal::TimePoint passed = clock_->now();
  EXPECT_FALSE(clock_->wait_until(semaphore, passed));
  semaphore.post();
  semaphore.post();
  EXPECT_TRUE(clock_->wait_until(semaphore, clock_->now() + std::chrono::hours{1}));
  EXPECT_FALSE(clock_->wait_until(semaphore, passed));
  EXPECT_FALSE(clock_->wait_until(semaphore, hal::TimePoint::min()));
  semaphore.post();
  EXPECT_TRUE(clock_->wait_until(semaphore, passed)) << "a post counts, late as it is";
}

TEST_P(ClockContract, a_wait_ends_at_a_post_of_another_thread) {
  hal::Semaphore semaphore;
  for (int i = 0; i < 100; ++i) {
    std::thread poster{[&] { semaphore.post(); }};
    EXPECT_TRUE(clock_->wait_until(semaphore, clock_->now() + std::chrono::hours{1}));
    poster.join();
  }
}

// Should the other thread sleep first, a clock that sleeping moves is there already.
TEST_P(ClockContract, a_wait_ends_at_or_after_its_deadline) {
  hal::Semaphore semaphore;
  for (int i = 0; i < 20; ++i) {
    const hal::TimePoint deadline = clock_->now() + std::chrono::milliseconds{1};
    std::thread sleeper{[&] { clock_->sleep_until(deadline); }};
    EXPECT_FALSE(clock_->wait_until(semaphore, deadline));
    EXPECT_GE(clock_->now(), deadline);
    sleeper.join();
  }
}

} // namespace octascope::tests
