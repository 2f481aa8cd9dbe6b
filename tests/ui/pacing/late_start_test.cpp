// Frames on a simulated output: a knob is turned and volumes come at any time, frames take what they
// take, and what was there when a frame began is seen at the refresh that the frame meets.
#include <algorithm>
#include <chrono>
#include <functional>
#include <optional>
#include <random>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "ui/pacing/late_start.h"

namespace octascope::tests {
namespace {

using hal::Duration;
using hal::TimePoint;
using std::chrono::microseconds;
using std::chrono::milliseconds;

constexpr Duration period = microseconds{16667};

struct Outcome {
  std::vector<Duration> ages; // of what is seen, from the event to the refresh
  int frames = 0;
  int missed = 0; // refreshes without a new frame

  Duration age(double share) {
    std::ranges::sort(ages);
    return ages[static_cast<std::size_t>(share * static_cast<double>(ages.size() - 1))];
  }
};

Duration waking(std::mt19937& generator) {
  return microseconds{std::uniform_int_distribution<int>{50, 150}(generator)};
}

// For a minute. Events come every 3 to 40 ms; each is drawn by the first frame that begins after it. Whoever
// sleeps wakes a little late.
Outcome run(bool late, const std::function<Duration(std::mt19937&)>& cost) {
  std::mt19937 generator{7};
  std::uniform_int_distribution<int> apart_us{3000, 40000};
  ui::LateStart start;
  Outcome outcome;
  TimePoint now{milliseconds{5}};
  TimePoint refresh{};
  TimePoint event = now;
  std::vector<TimePoint> waiting;
  while (now < TimePoint{std::chrono::minutes{1}}) {
    if (const TimePoint planned = late ? start.begin(now, refresh, period) : now; planned > now)
      now = planned + waking(generator);
    for (; event <= now; event += microseconds{apart_us(generator)})
      waiting.push_back(event);
    const Duration took = cost(generator);
    const TimePoint drawn = now + took;
    const auto passed = (drawn - refresh - Duration{1}) / period + 1;
    outcome.missed += static_cast<int>(passed) - 1;
    refresh += passed * period;
    start.note(took, refresh);
    for (const TimePoint each : waiting)
      outcome.ages.push_back(refresh - each);
    waiting.clear();
    ++outcome.frames;
    now = refresh + waking(generator);
  }
  return outcome;
}

TEST(LateStart, shows_what_came_meanwhile_and_misses_no_refresh) {
  const auto steady = [](std::mt19937& generator) {
    return microseconds{std::uniform_int_distribution<int>{2500, 3500}(generator)};
  };
  Outcome early = run(false, steady);
  Outcome late = run(true, steady);
  EXPECT_EQ(early.missed, 0);
  EXPECT_EQ(late.missed, 0);
  EXPECT_EQ(late.frames, early.frames);
  fmt::print("  from event to refresh: p50 {:.1f} -> {:.1f}, p95 {:.1f} -> {:.1f} ms\n",
             hal::to_ms(early.age(0.5)), hal::to_ms(late.age(0.5)), hal::to_ms(early.age(0.95)),
             hal::to_ms(late.age(0.95)));
  EXPECT_LT(late.age(0.5), early.age(0.5) - milliseconds{10});
  EXPECT_LT(late.age(0.95), milliseconds{23}) << "a period, what a frame takes, a margin";
}

TEST(LateStart, one_frame_in_six_that_takes_longer_is_reckoned_with) {
  int number = 0;
  const auto with_volumes = [&](std::mt19937&) {
    return ++number % 6 == 0 ? microseconds{8000} : microseconds{2500};
  };
  Outcome late = run(true, with_volumes);
  EXPECT_LE(late.missed, 1) << "the first of them comes as a surprise";
  number = 0;
  EXPECT_LT(late.age(0.5), run(false, with_volumes).age(0.5) - milliseconds{4});
}

TEST(LateStart, surprises_widen_the_margin) {
  const auto with_surprises = [](std::mt19937& generator) {
    const bool surprise = std::uniform_int_distribution<int>{0, 99}(generator) == 0;
    return microseconds{surprise ? 5500 : 2500};
  };
  Outcome late = run(true, with_surprises);
  EXPECT_LT(late.missed, late.frames / 100) << "fewer than there are surprises";
}

// Nothing wakes the renderer but its own time: a rolling volume's B-scans come without a word.
TEST(LateStart, looks_once_in_each_period_whether_it_draws_or_not) {
  for (const bool draws : {true, false}) {
    std::mt19937 generator{3};
    ui::LateStart start;
    start.note(milliseconds{3}, {});
    TimePoint now{milliseconds{4}};
    TimePoint refresh{};
    int looks = 0;
    for (; now < TimePoint{milliseconds{900}}; ++looks) {
      const TimePoint planned = start.begin(now, refresh, period);
      now = std::max(now, planned + (planned > now ? waking(generator) : Duration{}));
      const TimePoint began = now;
      if (draws) {
        now += milliseconds{3};
        refresh += ((now - refresh - Duration{1}) / period + 1) * period;
        start.note(milliseconds{3}, refresh);
        now = refresh + waking(generator);
      }
      const TimePoint next = start.next_look(began, now, refresh, period);
      EXPECT_GT(next, began);
      now = std::max(now, next + waking(generator));
    }
    EXPECT_NEAR(looks, milliseconds{896} / period, 2) << (draws ? "drawing" : "at rest");
  }
}

TEST(LateStart, a_busy_renderer_begins_at_once) {
  const auto slow = [](std::mt19937& generator) {
    return microseconds{std::uniform_int_distribution<int>{14000, 30000}(generator)};
  };
  EXPECT_EQ(run(true, slow).ages, run(false, slow).ages);
}

TEST(LateStart, begins_at_once_where_no_refresh_is_known) {
  ui::LateStart start;
  const TimePoint now{milliseconds{100}};
  const TimePoint refresh{milliseconds{99}};
  EXPECT_EQ(start.begin(now, refresh, period), now) << "nor what a frame takes";
  start.note(milliseconds{3}, now);
  EXPECT_EQ(start.begin(now, std::nullopt, period), now);
  const TimePoint later = now + std::chrono::seconds{2};
  EXPECT_EQ(start.begin(later, refresh, period), later) << "where it was, long ago";
  EXPECT_GT(start.begin(now, refresh, period), now);
}

// Whatever the phase, a frame is planned for the first refresh that it can reach.
TEST(LateStart, plans_for_the_first_refresh_that_can_be_reached) {
  const Duration cost = milliseconds{3};
  const Duration needed = cost + period / 10;
  for (int us = -40000; us < 40000; us += 137) {
    ui::LateStart start;
    start.note(cost, TimePoint{});
    const TimePoint refresh{milliseconds{500}};
    const TimePoint now = refresh + microseconds{us};
    const TimePoint begin = start.begin(now, refresh, period);
    EXPECT_GE(begin, now);
    EXPECT_LT(begin - now, period);
    const Duration off = (begin + needed - refresh + 100 * period) % period;
    EXPECT_LE(off, period / 20) << us << ": at most half of the margin late";
  }
}

TEST(LateStart, says_when_a_frame_is_seen) {
  const TimePoint refresh{milliseconds{100}};
  const TimePoint drawn{milliseconds{110}};
  EXPECT_EQ(ui::LateStart::seen(drawn, std::nullopt, period), drawn) << "at once";
  EXPECT_EQ(ui::LateStart::seen(drawn, drawn, period), drawn);
  EXPECT_EQ(ui::LateStart::seen(drawn, refresh, period), refresh + period);
  EXPECT_EQ(ui::LateStart::seen(drawn + period, refresh, period), refresh + 2 * period);
}

} // namespace
} // namespace octascope::tests
