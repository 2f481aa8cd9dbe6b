#include <gtest/gtest.h>

#include "firmware-host/report/rate_meter.h"

namespace octascope::firmware_host {
namespace {

using namespace std::chrono_literals;

constexpr hal::TimePoint t0{100s};

TEST(RateMeter, knows_nothing_at_first) {
  RateMeter meter;
  EXPECT_EQ(meter.per_second(), 0);
  meter.update(1000, t0);
  EXPECT_EQ(meter.per_second(), 0) << "a total that is there already is no rate";
}

TEST(RateMeter, measures_a_steady_rate_however_often_it_is_fed) {
  for (const hal::Duration step : {5ms, 16ms, 100ms, 300ms}) {
    RateMeter meter;
    for (hal::TimePoint t = t0; t < t0 + 10s; t += step)
      meter.update(static_cast<std::uint64_t>(hal::to_ms(t - t0) * 2), t); // 2000 a second
    EXPECT_NEAR(meter.per_second(), 2000, 20) << hal::to_ms(step);
  }
}

TEST(RateMeter, forgets_what_is_older_than_some_two_seconds) {
  RateMeter meter;
  for (int i = 0; i <= 100; ++i)
    meter.update(static_cast<std::uint64_t>(i) * 100, t0 + i * 250ms);
  EXPECT_NEAR(meter.per_second(), 400, 1);
  for (int i = 101; i <= 110; ++i) // it stopped
    meter.update(10'000, t0 + i * 250ms);
  EXPECT_EQ(meter.per_second(), 0);
}

} // namespace
} // namespace octascope::firmware_host
