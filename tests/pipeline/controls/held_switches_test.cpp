#include <gtest/gtest.h>

#include "pipeline/controls/held_switches.h"

namespace octascope::pipeline {
namespace {

using namespace std::chrono_literals;

constexpr hal::TimePoint t0{100s};

hal::ControlEvent pedal(hal::TimePoint time, int index, int value) {
  return {time, hal::ControlKind::pedal_switch, static_cast<std::uint8_t>(index), value};
}

TEST(HeldSwitches, a_press_is_told_once_when_it_lasts) {
  HeldSwitches held;
  EXPECT_FALSE(held.longest_untold(t0 + 1h));
  held.note(pedal(t0, 1, 1));
  EXPECT_FALSE(held.longest_untold(t0 + HeldSwitches::limit - 1ns));
  EXPECT_EQ(held.longest_untold(t0 + HeldSwitches::limit), 1U);
  EXPECT_FALSE(held.longest_untold(t0 + 1h));
}

TEST(HeldSwitches, a_short_press_is_not) {
  HeldSwitches held;
  held.note(pedal(t0, 0, 1));
  held.note(pedal(t0 + 3s, 0, 0));
  EXPECT_FALSE(held.longest_untold(t0 + 1h));
  held.note(pedal(t0 + 2h, 0, 1));
  EXPECT_TRUE(held.longest_untold(t0 + 2h + HeldSwitches::limit)) << "the next one is its own";
}

TEST(HeldSwitches, of_several_the_first_comes_first) {
  HeldSwitches held;
  held.note(pedal(t0 + 1s, 0, 1));
  held.note(pedal(t0, 2, 1));
  EXPECT_EQ(held.longest_untold(t0 + 1h), 2U);
  EXPECT_EQ(held.longest_untold(t0 + 1h), 0U);
  EXPECT_FALSE(held.longest_untold(t0 + 1h));
}

TEST(HeldSwitches, knobs_axes_and_switches_beyond_the_eighth_are_ignored) {
  HeldSwitches held;
  held.note({t0, hal::ControlKind::knob, 0, 1});
  held.note({t0, hal::ControlKind::axis, 0, 1});
  held.note(pedal(t0, 8, 1));
  EXPECT_FALSE(held.longest_untold(t0 + 1h));
}

} // namespace
} // namespace octascope::pipeline
