// The search for the highest rate finds it, wherever it begins, in few tries.
#include <gtest/gtest.h>

#include "firmware-host/commands/bench/rate_search.h"

namespace octascope::tests {
namespace {

using namespace firmware_host;

bool always() {
  return true;
}

TEST(RateSearch, finds_the_highest_that_holds_from_wherever_it_begins) {
  for (int highest = -1; highest < rate_rungs; ++highest)
    for (int start = 0; start < rate_rungs; ++start) {
      SCOPED_TRACE(testing::Message() << "highest " << highest << ", from " << start);
      int tries = 0;
      const auto found = highest_rung(
          {.start = start},
          [&](int rung) -> hal::Result<bool> {
            EXPECT_GE(rung, 0);
            EXPECT_LT(rung, rate_rungs);
            ++tries;
            return rung <= highest;
          },
          always);
      ASSERT_TRUE(found);
      EXPECT_EQ(found->rung, highest);
      EXPECT_TRUE(found->complete);
      EXPECT_LE(tries, 10);
    }
}

TEST(RateSearch, tries_none_that_is_known_not_to_hold) {
  for (int rungs = 1; rungs <= 8; ++rungs)
    for (int start = 0; start < rate_rungs; ++start) {
      SCOPED_TRACE(testing::Message() << rungs << " rungs, from " << start);
      const auto found = highest_rung(
          {.start = start, .rungs = rungs},
          [&](int rung) -> hal::Result<bool> {
            EXPECT_LT(rung, rungs);
            return true;
          },
          always);
      ASSERT_TRUE(found);
      EXPECT_EQ(found->rung, rungs - 1);
      EXPECT_TRUE(found->complete);
    }
}

TEST(RateSearch, ends_with_what_it_knows_when_the_time_is_over) {
  int tries = 0;
  const auto found = highest_rung(
      {.start = 4},
      [&](int) -> hal::Result<bool> {
        ++tries;
        return true;
      },
      [&] { return tries < 2; });
  ASSERT_TRUE(found);
  EXPECT_EQ(found->rung, 5);
  EXPECT_FALSE(found->complete);
}

TEST(RateSearch, passes_an_error_on) {
  const auto found = highest_rung(
      {.start = 3},
      [](int) -> hal::Result<bool> { return hal::fail(hal::ErrorCode::system, "no place"); },
      always);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().message, "no place");
}

TEST(RateSearch, rungs_are_a_quarter_of_an_octave_apart) {
  EXPECT_DOUBLE_EQ(rate_hz(0), 100e3);
  EXPECT_DOUBLE_EQ(rate_hz(4), 200e3);
  EXPECT_DOUBLE_EQ(rate_hz(rate_rungs - 1), 6.4e6);
}

} // namespace
} // namespace octascope::tests
