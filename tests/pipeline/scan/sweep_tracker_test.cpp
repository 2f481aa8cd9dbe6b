#include <gtest/gtest.h>

#include "pipeline/scan/sweep_tracker.h"
#include "tests/support/must.h"

namespace octascope::pipeline {
namespace {

using namespace std::chrono_literals;

const hal::TimePoint start{1s};

void expect_all_sweeps_placed(SweepTracker& tracker, const ScanPlan& plan, std::uint64_t volume,
                              hal::TimePoint begin) {
  for (int b = 0; b < plan.b_scans; ++b) {
    const auto slot = tracker.place(begin + b * plan.frame_period());
    ASSERT_TRUE(slot) << "B-scan " << b;
    EXPECT_EQ(slot->volume, volume);
    EXPECT_EQ(slot->sweep, b);
  }
}

TEST(SweepTracker, places_frames_by_their_time) {
  const ScanPlan plan;
  SweepTracker tracker{plan};
  EXPECT_EQ(tracker.pulsed(1, start), start + plan.sweep_duration());
  for (const int b : {0, 5, 41, 79}) {
    const auto slot = tests::must(tracker.place(start + b * plan.frame_period() + 20us));
    EXPECT_EQ(slot.volume, 1U);
    EXPECT_EQ(slot.sweep, b);
  }
  EXPECT_FALSE(tracker.place(start + 81 * plan.frame_period()));
  EXPECT_FALSE(tracker.place(start - plan.frame_period()));
}

TEST(SweepTracker, counts_repeats_like_any_other_sweep) {
  ScanPlan plan;
  plan.repeats = 4;
  SweepTracker tracker{plan};
  const hal::TimePoint end = tracker.pulsed(1, start);
  EXPECT_EQ(end, start + plan.sweep_duration());
  const auto slot = tests::must(tracker.place(start + 319 * plan.frame_period()));
  EXPECT_EQ(slot.sweep, 319);
  EXPECT_FALSE(tracker.place(start + 320 * plan.frame_period()));
}

TEST(SweepTracker, knows_that_a_pulse_during_a_sweep_is_latched) {
  const ScanPlan plan;
  SweepTracker tracker{plan};
  const hal::TimePoint second = tracker.pulsed(1, start);
  EXPECT_EQ(tracker.pulsed(2, second - 7ms), second + plan.sweep_duration());
  const auto last = tests::must(tracker.place(second - plan.frame_period()));
  EXPECT_EQ(last.volume, 1U);
  EXPECT_EQ(last.sweep, 79);
  const auto first = tests::must(tracker.place(second));
  EXPECT_EQ(first.volume, 2U);
  EXPECT_EQ(first.sweep, 0);
}

// The first pulse came late, the scanner missed the second, and so nothing held up the third: its
// frames are its own from the first on, none is taken for the end of the volume that never came.
TEST(SweepTracker, knows_that_a_missed_pulse_latches_nothing) {
  const ScanPlan plan;
  SweepTracker tracker{plan};
  const hal::TimePoint second = tracker.pulsed(1, start);
  ASSERT_TRUE(tracker.place(start));
  tracker.pulsed(2, second - 7ms);
  const hal::TimePoint third = second - 7ms + plan.sweep_duration();
  tracker.pulsed(3, third);
  expect_all_sweeps_placed(tracker, plan, 3, third);
}

// As above, but it was the camera that lost all frames of the second volume.
TEST(SweepTracker, knows_that_a_volume_whose_frames_were_lost_latched_the_next) {
  const ScanPlan plan;
  SweepTracker tracker{plan};
  const hal::TimePoint second = tracker.pulsed(1, start);
  ASSERT_TRUE(tracker.place(start));
  const hal::TimePoint third = tracker.pulsed(2, second - 2500us);
  tracker.pulsed(3, third - 2500us);
  expect_all_sweeps_placed(tracker, plan, 3, third);
}

// A camera clock 0.5 % slow, and pulses latched for ever: without correction the second volume
// would already be half a B-scan off, the tenth four.
TEST(SweepTracker, follows_a_camera_whose_clock_drifts) {
  const ScanPlan plan;
  SweepTracker tracker{plan};
  const hal::Duration true_period = plan.frame_period() * 1005 / 1000;
  hal::TimePoint true_time = start;
  for (std::uint64_t volume = 1; volume <= 20; ++volume) {
    tracker.pulsed(volume, true_time - (volume == 1 ? 0ms : 1ms));
    for (int b = 0; b < plan.b_scans; ++b, true_time += true_period) {
      const auto slot = tests::must(tracker.place(true_time));
      ASSERT_EQ(slot.volume, volume);
      ASSERT_EQ(slot.sweep, b);
    }
  }
}

TEST(SweepTracker, places_nothing_before_the_first_pulse) {
  SweepTracker tracker{ScanPlan{}};
  EXPECT_FALSE(tracker.place(start));
}

} // namespace
} // namespace octascope::pipeline
