#include <chrono>

#include "hal/linux/monotonic_clock.h"
#include "tests/contract/clock_contract.h"

namespace octascope::tests {
namespace {

INSTANTIATE_TEST_SUITE_P(
    monotonic, ClockContract,
    testing::Values(ClockCase{
        "linux", [] { return std::make_unique<hal::linux_backend::MonotonicClock>(); }}),
    NameOfCase{});

TEST(MonotonicClock, is_on_the_axis_of_the_kernel) {
  // libstdc++ reads CLOCK_MONOTONIC for its steady clock: two readers of one axis.
  const hal::linux_backend::MonotonicClock clock;
  const auto before = std::chrono::steady_clock::now().time_since_epoch();
  const hal::Duration now = clock.now().time_since_epoch();
  const auto after = std::chrono::steady_clock::now().time_since_epoch();
  EXPECT_LE(before, now);
  EXPECT_LE(now, after);
}

} // namespace
} // namespace octascope::tests
