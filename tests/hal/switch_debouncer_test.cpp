#include <algorithm>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "hal/switch_debouncer.h"

namespace octascope::hal {
namespace {

using namespace std::chrono_literals;

constexpr TimePoint t0{1s};

TEST(SwitchDebouncer, a_change_counts_when_it_has_rested) {
  SwitchDebouncer contact{5ms};
  EXPECT_FALSE(contact.due());
  contact.contact(t0, true);
  EXPECT_EQ(contact.due(), t0 + 5ms);
  EXPECT_FALSE(contact.settle(t0 + 5ms - 1ns));
  EXPECT_FALSE(contact.closed());
  const auto change = contact.settle(t0 + 5ms);
  ASSERT_TRUE(change);
  EXPECT_EQ(change->time, t0);
  EXPECT_TRUE(change->closed);
  EXPECT_TRUE(contact.closed());
  EXPECT_FALSE(contact.settle(t0 + 1h)) << "told once";
}

TEST(SwitchDebouncer, spikes_are_never_seen) {
  SwitchDebouncer contact{5ms};
  contact.contact(t0, true);
  contact.contact(t0 + 4ms, false);
  EXPECT_FALSE(contact.settle(t0 + 1h));
}

TEST(SwitchDebouncer, counts_what_it_takes_out) {
  SwitchDebouncer contact{5ms};
  contact.contact(t0, true);
  ASSERT_TRUE(contact.settle(t0 + 5ms));
  EXPECT_EQ(contact.bounces(), 0U) << "a clean press";
  contact.contact(t0 + 10ms, false);
  contact.contact(t0 + 11ms, true);
  contact.contact(t0 + 12ms, false);
  contact.contact(t0 + 13ms, true);
  contact.contact(t0 + 14ms, false);
  ASSERT_TRUE(contact.settle(t0 + 19ms));
  EXPECT_EQ(contact.bounces(), 2U) << "two openings that did not last";
  contact.reset();
  EXPECT_EQ(contact.bounces(), 2U);
}

TEST(SwitchDebouncer, repeating_a_level_does_not_prolong_the_wait) {
  SwitchDebouncer contact{5ms};
  contact.contact(t0, true);
  contact.contact(t0 + 4ms, true);
  EXPECT_TRUE(contact.settle(t0 + 5ms));
}

TEST(SwitchDebouncer, forgets_on_reset) {
  SwitchDebouncer contact{5ms};
  contact.contact(t0, true);
  ASSERT_TRUE(contact.settle(t0 + 5ms));
  contact.contact(t0 + 6ms, false);
  contact.reset();
  EXPECT_FALSE(contact.closed());
  EXPECT_FALSE(contact.settle(t0 + 1h));
}

// Against the definition: at each millisecond the device says the level that held through the last
// whole 5 ms, or what it said before when none did.
TEST(SwitchDebouncer, agrees_with_the_definition_on_random_contacts) {
  std::mt19937 random{1};
  constexpr int length_ms = 20'000;
  std::vector<bool> levels(length_ms, false);
  for (int ms = 10; ms < length_ms; ++ms)
    levels[static_cast<std::size_t>(ms)] =
        levels[static_cast<std::size_t>(ms) - 1] != (random() % 6 == 0);

  SwitchDebouncer contact{5ms};
  bool expected = false;
  int changes = 0;
  for (std::ptrdiff_t ms = 5; ms < length_ms; ++ms) {
    const TimePoint t = t0 + std::chrono::milliseconds{ms};
    changes += contact.settle(t).has_value();
    contact.contact(t, levels[static_cast<std::size_t>(ms)]);
    const auto begin = levels.begin() + ms - 5;
    if (std::adjacent_find(begin, begin + 5, std::not_equal_to<>{}) == begin + 5)
      expected = *begin;
    ASSERT_EQ(contact.closed(), expected) << ms << " ms";
  }
  EXPECT_GT(changes, 100);
}

} // namespace
} // namespace octascope::hal
