#include <gtest/gtest.h>

#include "pipeline/controls/held_switches.h"

namespace octascope::pipeline {
namespace {

using namespace std::chrono_literals;

constexpr hal::TimePoint t0{100s};

TEST(HeldSwitches, a_press_is_told_once_when_it_lasts) {
  HeldSwitches held;
  EXPECT_FALSE(held.longest_untold(t0 + 1h));
  held.note(1, true, t0);
  EXPECT_FALSE(held.longest_untold(t0 + HeldSwitches::limit - 1ns));
  EXPECT_EQ(held.longest_untold(t0 + HeldSwitches::limit), 1U);
  EXPECT_FALSE(held.longest_untold(t0 + 1h));
}

TEST(HeldSwitches, a_short_press_is_not) {
  HeldSwitches held;
  held.note(0, true, t0);
  held.note(0, false, t0 + 3s);
  EXPECT_FALSE(held.longest_untold(t0 + 1h));
  held.note(0, true, t0 + 2h);
  EXPECT_TRUE(held.longest_untold(t0 + 2h + HeldSwitches::limit)) << "the next one is its own";
}

TEST(HeldSwitches, of_several_the_first_comes_first) {
  HeldSwitches held;
  held.note(0, true, t0 + 1s);
  held.note(2, true, t0);
  EXPECT_EQ(held.longest_untold(t0 + 1h), 2U);
  EXPECT_EQ(held.longest_untold(t0 + 1h), 0U);
  EXPECT_FALSE(held.longest_untold(t0 + 1h));
}

TEST(HeldSwitches, says_what_is_down_and_what_changes_nothing) {
  HeldSwitches held;
  EXPECT_TRUE(held.note(3, true, t0));
  EXPECT_FALSE(held.note(3, true, t0 + 1s));
  EXPECT_EQ(held.since(3), t0);
  EXPECT_TRUE(held.note(31, true, t0));
  EXPECT_EQ(held.down(), 1U << 3 | 1U << 31);
  EXPECT_TRUE(held.note(3, false, t0 + 2s));
  EXPECT_FALSE(held.note(3, false, t0 + 2s));
  EXPECT_FALSE(held.is_down(3));
  EXPECT_TRUE(held.is_down(31));
  EXPECT_FALSE(held.note(32, true, t0)) << "there is none of that index";
}

} // namespace
} // namespace octascope::pipeline
