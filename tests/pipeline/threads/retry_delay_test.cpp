#include <gtest/gtest.h>

#include "pipeline/threads/retry_delay.h"

namespace octascope::pipeline {
namespace {

using namespace std::chrono_literals;

const hal::TimePoint t0{100s};

// Tries, all in vain, up to the one at or after `away`; the pause after that.
hal::Duration pause_after(RetryDelay& retry, hal::Duration away) {
  hal::TimePoint now = t0;
  for (;;) {
    EXPECT_TRUE(retry.due(now));
    retry.failure(now);
    if (now - t0 >= away)
      return retry.next() - now;
    now = retry.next();
  }
}

TEST(RetryDelay, is_a_quarter_of_the_time_away) {
  RetryDelay retry;
  EXPECT_EQ(pause_after(retry, 0s), 100ms);
  EXPECT_FALSE(retry.due(t0 + 99ms));
  for (const hal::Duration away : {1s, 2s, 4s}) {
    RetryDelay longer;
    const hal::Duration pause = pause_after(longer, away);
    EXPECT_GE(pause, away / 4);
    EXPECT_LE(pause, away * 5 / 16); // of the last try, at most a quarter later
  }
}

TEST(RetryDelay, is_two_seconds_at_most) {
  RetryDelay retry;
  EXPECT_EQ(pause_after(retry, 10s), 2s);
  RetryDelay of_hours;
  EXPECT_EQ(pause_after(of_hours, 3h), 2s);
}

TEST(RetryDelay, starts_over_after_success) {
  RetryDelay retry;
  pause_after(retry, 60s);
  retry.success();
  EXPECT_TRUE(retry.due(t0));
  EXPECT_EQ(pause_after(retry, 0s), 100ms);
}

} // namespace
} // namespace octascope::pipeline
