#include <gtest/gtest.h>

#include "hal/linux/aravis/camera_clock.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using hal::TimePoint;
using hal::linux_backend::CameraClock;
using hal::linux_backend::FrameCounter;

constexpr TimePoint start{1000s};
constexpr std::uint64_t camera_start_ns = 77'000'000'000;

std::uint64_t stamp(hal::Duration after) {
  return camera_start_ns + static_cast<std::uint64_t>(after.count());
}

TEST(CameraClock, a_late_arrival_does_not_make_a_frame_late) {
  CameraClock clock;
  EXPECT_EQ(clock.end_of_frame(stamp(0ms), start + 1ms), start + 1ms);
  // Ten milliseconds in the queue, and a clock that is let drift by two microseconds meanwhile.
  const TimePoint end = clock.end_of_frame(stamp(10ms), start + 21ms);
  EXPECT_GE(end, start + 11ms);
  EXPECT_LE(end, start + 11ms + 2us);
}

TEST(CameraClock, an_earlier_arrival_corrects_those_after_it) {
  CameraClock clock;
  clock.end_of_frame(stamp(0ms), start + 9ms);
  EXPECT_EQ(clock.end_of_frame(stamp(10ms), start + 11ms), start + 11ms);
  EXPECT_LE(clock.end_of_frame(stamp(20ms), start + 29ms), start + 21ms + 2us);
}

TEST(CameraClock, a_clock_that_runs_otherwise_is_followed) {
  for (const double drift : {-100e-6, 100e-6}) {
    CameraClock clock;
    for (int frame = 0; frame < 100'000; ++frame) {
      const hal::Duration host = frame * 10ms;
      const auto camera =
          hal::Duration{static_cast<std::int64_t>(static_cast<double>(host.count()) * (1 + drift))};
      const hal::Duration delay = 1ms + (frame % 7) * 1ms;
      const TimePoint end = clock.end_of_frame(stamp(camera), start + host + delay);
      ASSERT_GE(end, start + host + 1ms - 20us) << frame;
      ASSERT_LE(end, start + host + 1ms + (frame < 7 ? 6ms : 50us)) << frame;
    }
  }
}

TEST(CameraClock, is_never_later_than_the_arrival) {
  CameraClock clock;
  clock.end_of_frame(stamp(0ms), start + 5ms);
  EXPECT_LE(clock.end_of_frame(stamp(10ms), start + 6ms), start + 6ms);
}

TEST(CameraClock, what_is_no_stamp_gives_the_arrival_and_a_new_beginning) {
  CameraClock clock;
  clock.end_of_frame(stamp(1s), start);
  EXPECT_EQ(clock.end_of_frame(0, start + 10ms), start + 10ms);
  EXPECT_EQ(clock.end_of_frame(stamp(0s), start + 20ms), start + 20ms) << "reset";
  EXPECT_EQ(clock.end_of_frame(stamp(3600s), start + 30ms), start + 30ms) << "a leap";
  EXPECT_EQ(clock.end_of_frame(~0ULL, start + 40ms), start + 40ms);
  EXPECT_EQ(clock.end_of_frame(stamp(5ms), start + 50ms), start + 50ms);
  EXPECT_LE(clock.end_of_frame(stamp(15ms), start + 69ms), start + 60ms + 2us) << "exact again";
}

TEST(FrameCounter, begins_at_0_and_shows_gaps) {
  FrameCounter counter;
  EXPECT_EQ(counter.extend(65'000), 0U);
  EXPECT_EQ(counter.extend(65'001), 1U);
  EXPECT_EQ(counter.extend(65'005), 5U);
}

TEST(FrameCounter, short_numbers_go_on_at_1_without_a_gap) {
  FrameCounter counter;
  counter.extend(65'534);
  EXPECT_EQ(counter.extend(65'535), 1U);
  EXPECT_EQ(counter.extend(1), 2U);
  EXPECT_EQ(counter.extend(3), 4U);
}

TEST(FrameCounter, long_numbers_have_no_end) {
  FrameCounter counter;
  counter.extend(65'535);
  EXPECT_EQ(counter.extend(65'536), 1U);
  EXPECT_EQ(counter.extend(5'000'000'000), 4'999'934'465U);
}

TEST(FrameCounter, a_lost_number_is_taken_as_the_next) {
  FrameCounter counter;
  EXPECT_EQ(counter.guess(), 0U);
  EXPECT_EQ(counter.extend(8), 1U);
  EXPECT_EQ(counter.guess(), 2U);
  EXPECT_EQ(counter.guess(), 3U);
  EXPECT_EQ(counter.extend(11), 4U);
  EXPECT_EQ(counter.extend(12), 5U);
}

TEST(FrameCounter, an_old_number_follows_nothing) {
  FrameCounter counter;
  EXPECT_FALSE(counter.follows(0));
  EXPECT_TRUE(counter.follows(65'500));
  counter.extend(65'500);
  EXPECT_TRUE(counter.follows(65'501));
  EXPECT_FALSE(counter.follows(65'500));
  EXPECT_FALSE(counter.follows(65'490));
  EXPECT_TRUE(counter.follows(1)) << "after 65535";
  counter.extend(3);
  EXPECT_FALSE(counter.follows(65'530)) << "of before the new beginning";
}

TEST(FrameCounter, a_number_that_hangs_or_goes_back_does_not_advance_it) {
  FrameCounter counter;
  counter.extend(10);
  EXPECT_EQ(counter.extend(12), 2U);
  EXPECT_EQ(counter.extend(12), 2U);
  EXPECT_EQ(counter.extend(11), 2U);
  EXPECT_EQ(counter.extend(13), 4U);
}

} // namespace
} // namespace octascope::tests
