#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/threads/duration_statistics.h"

namespace octascope::pipeline {
namespace {

TEST(DurationStatistics, percentiles_are_right_within_two_percent) {
  DurationStatistics statistics;
  std::mt19937 random{3};
  std::lognormal_distribution<double> ms{1.0, 1.5};
  std::vector<double> all;
  for (int i = 0; i < 20000; ++i) {
    all.push_back(ms(random));
    statistics.add(hal::from_seconds(all.back() * 1e-3));
  }
  std::sort(all.begin(), all.end());
  const DurationSummary s = statistics.summary();
  EXPECT_EQ(s.count, 20000U);
  EXPECT_NEAR(s.p50_ms / all[10000 - 1], 1.0, 0.02);
  EXPECT_NEAR(s.p95_ms / all[19000 - 1], 1.0, 0.02);
  EXPECT_NEAR(s.max_ms, all.back(), 1e-5);
}

TEST(DurationStatistics, is_zero_when_empty_and_never_over_the_maximum) {
  DurationStatistics statistics;
  EXPECT_EQ(statistics.summary().count, 0U);
  EXPECT_EQ(statistics.summary().p95_ms, 0.0);
  statistics.add(std::chrono::milliseconds{10});
  EXPECT_LE(statistics.summary().p95_ms, 10.0);
}

} // namespace
} // namespace octascope::pipeline
