#include <gtest/gtest.h>

#include "sim/clock/virtual_clock.h"

namespace octascope::sim {
namespace {

TEST(VirtualClock, sleeping_moves_time_and_past_deadlines_do_not) {
  VirtualClock clock;
  const hal::TimePoint start = clock.now();
  clock.sleep_for(std::chrono::hours{1});
  EXPECT_EQ(clock.now() - start, std::chrono::hours{1});
  clock.sleep_until(start);
  EXPECT_EQ(clock.now() - start, std::chrono::hours{1});
}

} // namespace
} // namespace octascope::sim
