#include <gtest/gtest.h>

#include "ui/controls/knob_acceleration.h"

namespace octascope::ui {
namespace {

using namespace std::chrono_literals;

constexpr hal::TimePoint t0{100s};

// Units a detent, after so many detents evenly spaced.
double settled_units(int detents_per_turn, hal::Duration spacing, int detents = 200) {
  KnobMotion motion;
  for (int i = 0; i < detents; ++i)
    motion = motion.turned(1, detents_per_turn, t0 + i * spacing);
  return motion.units;
}

TEST(KnobAcceleration, slow_is_one_to_one_and_fast_is_eight_and_all_between_grows) {
  EXPECT_EQ(acceleration(0), 1);
  EXPECT_EQ(acceleration(0.5), 1);
  EXPECT_NEAR(acceleration(4), 8, 1e-12);
  EXPECT_NEAR(acceleration(100), 8, 1e-12);
  double last = 1;
  for (double speed = 0.4; speed < 5; speed += 0.001) {
    const double now = acceleration(speed);
    EXPECT_GE(now, last - 1e-12);
    EXPECT_LT(now - last, 0.02) << "without a jump";
    last = now;
  }
}

TEST(KnobAcceleration, the_faster_the_turning_the_farther_each_detent) {
  double last = 9;
  for (int ms = 2; ms < 300; ++ms) {
    const double units = settled_units(24, std::chrono::milliseconds{ms});
    EXPECT_LE(units, last + 1e-9) << ms << " ms";
    EXPECT_GE(units, 1);
    EXPECT_LE(units, 8);
    last = units;
  }
  EXPECT_EQ(settled_units(24, 100ms), 1);
  EXPECT_NEAR(settled_units(24, 5ms), 8, 1e-9);
}

TEST(KnobAcceleration, two_knobs_of_different_fineness_feel_alike) {
  // Two turns a second on both: the same in all.
  const double coarse = 24 * settled_units(24, 20833us, 100);
  const double fine = 96 * settled_units(96, 5208us, 400);
  EXPECT_NEAR(coarse, fine, 0.02 * coarse);
  EXPECT_EQ(slow_units(1, 24), 1);
  EXPECT_EQ(slow_units(-2, 10), -2) << "coarser ones are not made finer";
  EXPECT_EQ(slow_units(4, 96), 1);
}

TEST(KnobAcceleration, a_first_event_and_a_turn_back_are_slow) {
  KnobMotion motion;
  motion = motion.turned(4, 24, t0);
  EXPECT_EQ(motion.units, 4);
  for (int i = 1; i < 60; ++i)
    motion = motion.turned(1, 24, t0 + i * 4ms);
  EXPECT_GT(motion.units, 7);
  const KnobMotion back = motion.turned(-1, 24, t0 + 244ms);
  EXPECT_EQ(back.units, -1);
  const KnobMotion later = motion.turned(1, 24, t0 + 3s);
  EXPECT_NEAR(later.units, 1, 1e-9) << "after a rest";
  EXPECT_EQ(motion.turned(0, 24, t0 + 5s).last, motion.last) << "no detents, no event";
}

TEST(KnobAcceleration, a_packet_of_events_and_times_that_go_back_do_no_harm) {
  KnobMotion motion = KnobMotion{}.turned(1, 24, t0);
  motion = motion.turned(1, 24, t0 + 1s);
  motion = motion.turned(1, 24, t0 + 1s);
  EXPECT_LT(motion.units, 1.5);
  motion = motion.turned(1, 24, t0);
  EXPECT_EQ(motion.last, t0 + 1s);
  EXPECT_LE(motion.units, 8);
}

TEST(AxisResponse, has_a_dead_zone_is_odd_and_grows_to_one) {
  EXPECT_EQ(axis_response(0), 0);
  EXPECT_EQ(axis_response(80), 0);
  EXPECT_EQ(axis_response(-80), 0);
  EXPECT_GT(axis_response(81), 0);
  EXPECT_LT(axis_response(90), 0.01) << "no jump at its border";
  EXPECT_NEAR(axis_response(1000), 1, 1e-12);
  EXPECT_NEAR(axis_response(32000), 1, 1e-12);
  EXPECT_LT(axis_response(540), 0.5) << "finer near the middle";
  for (int value = 0; value < 1000; ++value) {
    EXPECT_LE(axis_response(value), axis_response(value + 1));
    EXPECT_EQ(axis_response(-value), -axis_response(value));
  }
}

} // namespace
} // namespace octascope::ui
