#include <gtest/gtest.h>

#include "ui/status/freshness.h"

namespace octascope::ui {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;
using std::chrono::seconds;

constexpr hal::TimePoint arrived{seconds{10}};
constexpr ShownVolume shown{arrived - milliseconds{60}, arrived};
constexpr FreshnessLimits limits{milliseconds{140}, seconds{5}};

Liveness liveness_at(hal::Duration after) {
  return judge_freshness(shown, arrived + after, limits, {}).liveness;
}

TEST(Freshness, waits_for_the_first_volume) {
  EXPECT_EQ(judge_freshness({}, arrived, limits, {}).liveness, Liveness::waiting);
  EXPECT_EQ(judge_freshness({}, arrived, limits, arrived).liveness, Liveness::waiting);
}

TEST(Freshness, stale_past_one_and_a_half_periods_and_not_before) {
  EXPECT_EQ(liveness_at({}), Liveness::live);
  EXPECT_EQ(liveness_at(milliseconds{140}), Liveness::live);
  EXPECT_EQ(liveness_at(milliseconds{210}), Liveness::live);
  EXPECT_EQ(liveness_at(milliseconds{210} + nanoseconds{1}), Liveness::stale);
}

TEST(Freshness, veiled_past_the_limit) {
  EXPECT_EQ(liveness_at(seconds{5}), Liveness::stale);
  EXPECT_EQ(liveness_at(seconds{5} + nanoseconds{1}), Liveness::veiled);
}

TEST(Freshness, age_counts_from_the_last_line) {
  EXPECT_EQ(judge_freshness(shown, arrived + milliseconds{40}, limits, {}).age, milliseconds{100});
  EXPECT_EQ(judge_freshness(shown, arrived - seconds{1}, limits, {}).age, hal::Duration{});
}

TEST(Freshness, frozen_wins_and_counts_its_own_time) {
  const Freshness f = judge_freshness(shown, arrived + seconds{20}, limits, arrived + seconds{8});
  EXPECT_EQ(f.liveness, Liveness::frozen);
  EXPECT_EQ(f.frozen_for, seconds{12});
  EXPECT_EQ(f.age, seconds{20} + milliseconds{60});
}

TEST(Freshness, what_was_recorded_is_never_live) {
  const ShownVolume recorded{shown.last_line, shown.arrived, true};
  for (const hal::Duration after :
       {hal::Duration{}, hal::Duration{seconds{1}}, hal::Duration{seconds{60}}})
    EXPECT_EQ(judge_freshness(recorded, arrived + after, limits, {}).liveness, Liveness::replayed);
  EXPECT_EQ(judge_freshness(recorded, arrived, limits, arrived).liveness, Liveness::frozen);
}

} // namespace
} // namespace octascope::ui
