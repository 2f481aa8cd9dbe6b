#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "hal/linux/v4l2/frame_times.h"
#include "tests/support/files/fresh_seed.h"

namespace octascope::hal::linux_backend {
namespace {

using namespace std::chrono_literals;
using Clock = FrameStamp::Clock;
using Moment = FrameStamp::Moment;

constexpr TimePoint now{1000s};

FrameStamp stamp(Clock clock, Moment moment, Duration since_boot) {
  const auto us = std::chrono::duration_cast<std::chrono::microseconds>(since_boot).count();
  return {clock, moment, us / 1'000'000, us % 1'000'000};
}

TEST(FrameTimes, an_end_stamp_is_the_end_of_the_last_line) {
  // 100 lines at 10 kHz: 10 ms.
  const auto times =
      exposure_times(stamp(Clock::monotonic, Moment::end, 999'990ms), now, false, 100, 10e3);
  EXPECT_EQ(times.first_line, TimePoint{999'980ms});
  EXPECT_EQ(times.last_line, TimePoint{999'990ms - 100us});
  EXPECT_FALSE(times.own_clock);
}

TEST(FrameTimes, a_start_stamp_is_the_start_of_the_first_line) {
  const auto times = exposure_times(stamp(Clock::monotonic, Moment::start_of_exposure, 999'980ms),
                                    now, false, 100, 10e3);
  EXPECT_EQ(times.first_line, TimePoint{999'980ms});
  EXPECT_EQ(times.last_line, TimePoint{999'990ms - 100us});
}

TEST(FrameTimes, a_stamp_ahead_of_now_is_now) {
  for (const Moment moment : {Moment::end, Moment::start_of_exposure}) {
    const auto times =
        exposure_times(stamp(Clock::monotonic, moment, 1000s + 15ms), now, false, 100, 10e3);
    EXPECT_FALSE(times.own_clock);
    EXPECT_LE(times.last_line, now);
    EXPECT_GE(times.last_line, now - 10ms);
    EXPECT_EQ(times.last_line - times.first_line, 9900us);
  }
}

TEST(FrameTimes, impossible_stamps_give_way_to_our_clock) {
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  constexpr std::int64_t least = std::numeric_limits<std::int64_t>::min();
  for (const auto& [seconds, us] : {std::pair<std::int64_t, std::int64_t>{0, 0},
                                    {2'147'483'632, 0},
                                    {9'223'372'020, 0},
                                    {most, 0},
                                    {least, least},
                                    {-1, 0},
                                    {999, 1'000'000},
                                    {999, -1},
                                    {most, most},
                                    {900, 0},
                                    {1001, 0}}) {
    const auto times =
        exposure_times({Clock::monotonic, Moment::end, seconds, us}, now, true, 100, 10e3);
    EXPECT_TRUE(times.own_clock) << seconds << " s " << us << " µs";
    EXPECT_EQ(times.first_line, now - 10ms);
    EXPECT_EQ(times.last_line, now - 100us);
  }
}

TEST(FrameTimes, an_unnamed_clock_is_believed_only_where_it_must_be_ours) {
  const FrameStamp recent = stamp(Clock::unnamed, Moment::end, 999'990ms);
  EXPECT_FALSE(exposure_times(recent, now, true, 100, 10e3).own_clock);
  EXPECT_TRUE(exposure_times(recent, now, false, 100, 10e3).own_clock);
  const FrameStamp old = stamp(Clock::unnamed, Moment::end, 990s);
  EXPECT_TRUE(exposure_times(old, now, true, 100, 10e3).own_clock);
  const FrameStamp copied = stamp(Clock::foreign, Moment::end, 999'990ms);
  EXPECT_TRUE(exposure_times(copied, now, true, 100, 10e3).own_clock);
}

TEST(FrameTimes, clocks_are_told_apart_by_their_distance) {
  EXPECT_TRUE(tells_clocks_apart(now, 1'700'000'000s));
  EXPECT_FALSE(tells_clocks_apart(now, 1000s)) << "a clock that started at 1970";
  EXPECT_FALSE(tells_clocks_apart(now, 1010s));
  EXPECT_TRUE(tells_clocks_apart(now, 0s));
}

TEST(FrameTimes, whatever_is_stamped_times_are_in_order_and_not_after_now) {
  std::mt19937_64 random{tests::fresh_seed()};
  const auto any = [&] {
    const auto bits = random() % 65;
    return static_cast<std::int64_t>(bits == 0 ? 0 : random() >> (64 - bits));
  };
  for (int i = 0; i < 200'000; ++i) {
    const FrameStamp made{static_cast<Clock>(random() % 3), static_cast<Moment>(random() % 2),
                          any(), any()};
    const TimePoint when{Duration{any() >> 2} + 1h};
    const int lines = 1 + static_cast<int>(random() % 10'000);
    const double rate = std::exp2(static_cast<double>(random() % 280) / 10);
    const auto times = exposure_times(made, when, random() % 2 == 0, lines, rate);
    ASSERT_LE(times.first_line, times.last_line);
    ASSERT_LE(times.last_line, when);
    ASSERT_NEAR(to_seconds(times.last_line - times.first_line), (lines - 1) / rate, 3e-9);
  }
}

} // namespace
} // namespace octascope::hal::linux_backend
