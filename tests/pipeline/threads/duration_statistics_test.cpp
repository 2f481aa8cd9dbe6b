#include <algorithm>
#include <array>
#include <cmath>
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
  std::ranges::sort(all);
  const DurationSummary s = statistics.summary();
  EXPECT_EQ(s.count, 20000U);
  EXPECT_NEAR(s.p50_ms / all[10000 - 1], 1.0, 0.02);
  EXPECT_NEAR(s.p95_ms / all[19000 - 1], 1.0, 0.02);
  EXPECT_NEAR(s.p99_ms / all[19800 - 1], 1.0, 0.02);
  EXPECT_NEAR(s.max_ms, all.back(), 1e-5);
}

TEST(DurationStatistics, a_histogram_counts_each_once) {
  DurationStatistics statistics;
  for (const double ms : {0.0, 0.05, 0.5, 0.5, 3.0, 90.0, 5000.0})
    statistics.add(hal::from_seconds(ms * 1e-3));
  std::array<std::uint64_t, 4> counts{9, 9, 9, 9};
  statistics.histogram(std::array{0.1, 1.0, 100.0}, counts);
  EXPECT_EQ(counts, (std::array<std::uint64_t, 4>{2, 2, 2, 1}));
}

TEST(DurationStatistics, is_zero_when_empty) {
  const DurationSummary s = DurationStatistics{}.summary();
  EXPECT_EQ(s.count, 0U);
  EXPECT_EQ(s.p50_ms, 0.0);
  EXPECT_EQ(s.p95_ms, 0.0);
  EXPECT_EQ(s.max_ms, 0.0);
}

// The middle of a bin lies beyond every second duration: then the duration itself is told.
TEST(DurationStatistics, a_percentile_is_near_and_never_over_the_maximum) {
  int at_the_maximum = 0;
  constexpr int durations = 1000;
  for (int i = 0; i < durations; ++i) {
    const double ms = 0.002 * std::pow(1.017, i); // to 42 s
    DurationStatistics statistics;
    statistics.add(hal::from_seconds(ms * 1e-3));
    const DurationSummary s = statistics.summary();
    EXPECT_EQ(s.count, 1U);
    EXPECT_NEAR(s.p50_ms / ms, 1, 0.0105) << ms;
    EXPECT_EQ(s.p50_ms, s.p95_ms);
    EXPECT_LE(s.p95_ms, s.max_ms);
    at_the_maximum += s.p95_ms == s.max_ms ? 1 : 0;
  }
  EXPECT_NEAR(at_the_maximum, durations / 2, durations / 10);
}

TEST(DurationStatistics, what_is_outside_all_bins_is_in_the_first_or_the_last) {
  DurationStatistics statistics;
  statistics.add(hal::Duration{3});
  EXPECT_EQ(statistics.summary().p95_ms, 3e-6) << "not the first bin's microsecond";
  statistics.add(std::chrono::hours{1});
  EXPECT_EQ(statistics.summary().count, 2U);
  EXPECT_NEAR(statistics.summary().p50_ms, 1e-3, 2e-5);
  EXPECT_GT(statistics.summary().p95_ms, 100e3) << "bins reach beyond 100 s";
  EXPECT_EQ(statistics.summary().max_ms, 3600e3);
}

} // namespace
} // namespace octascope::pipeline
