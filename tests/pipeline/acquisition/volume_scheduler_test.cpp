// Every decision of the fixed-rate thread, by explicit times: no clock, no thread, no sleep.
#include <algorithm>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/acquisition/volume_scheduler.h"
#include "tests/support/allocation_counter.h"

namespace octascope::pipeline {
namespace {

using namespace std::chrono_literals;
using Action = VolumeDecision::Action;

constexpr hal::TimePoint first_tick{10s};
constexpr hal::Duration moment{1}; // the least that can be told apart

// Eight sweeps of a millisecond.
ScanPlan short_plan() {
  ScanPlan plan;
  plan.samples = 32;
  plan.a_scans = 4;
  plan.fly_back_lines = 1;
  plan.b_scans = 8;
  plan.line_rate_hz = 5000;
  return plan;
}

class VolumeSchedulerTest : public testing::Test {
protected:
  explicit VolumeSchedulerTest(const ScanPlan& scan_plan = short_plan(),
                               std::optional<std::uint64_t> most_volumes = std::nullopt)
      : plan(scan_plan), scheduler(scan_plan, most_volumes) {
    scheduler.begin(first_tick);
  }

  // A tick at that time, whose pulse is made at once.
  std::optional<std::uint32_t> pulse(hal::TimePoint when) {
    EXPECT_TRUE(scheduler.tick_due(when));
    const TickDecision decision = scheduler.tick(when);
    EXPECT_EQ(decision.slept_through, 0U);
    EXPECT_TRUE(decision.pulse);
    return scheduler.pulsed(when);
  }
  hal::TimePoint tick(int n) const { return first_tick + n * plan.tick_period(); }
  hal::TimePoint time_of(hal::TimePoint armed, int sweep) const {
    return armed + sweep * plan.frame_period();
  }
  // Until when a volume takes frames, if the camera was looked at; and if it was not.
  hal::TimePoint accepts_until(hal::TimePoint armed) const {
    return armed + plan.sweep_duration() + plan.sweep_duration() / 6;
  }
  hal::Duration patience() const { return plan.sweep_duration() / 2; }

  FrameDecision frame(hal::TimePoint armed, int sweep) {
    const hal::TimePoint first_line = time_of(armed, sweep);
    return scheduler.place(first_line, first_line + 4 * plan.line_period());
  }
  // The workers are quick.
  void make(std::span<const BScanJob> jobs) {
    for (const BScanJob& job : jobs)
      scheduler.b_scan_made(job.buffer);
  }
  void deliver(hal::TimePoint armed, int begin, int end) {
    for (int sweep = begin; sweep < end; ++sweep) {
      const FrameDecision decision = frame(armed, sweep);
      EXPECT_EQ(decision.verdict, FrameVerdict::placed) << sweep;
      make(decision.submit);
    }
  }
  // The camera was looked at, and streams.
  VolumeDecision next(hal::TimePoint now) { return scheduler.next(now, now, true); }
  VolumeDecision next_unlooked(hal::TimePoint now) {
    return scheduler.next(now, hal::TimePoint{}, true);
  }
  std::vector<BScanJob> jobs(std::span<const BScanJob> decided) const {
    return {decided.begin(), decided.end()};
  }

  ScanPlan plan;
  VolumeScheduler scheduler;
};

TEST_F(VolumeSchedulerTest, a_tick_is_due_at_its_time_and_the_next_a_period_later) {
  EXPECT_FALSE(scheduler.tick_due(first_tick - moment));
  EXPECT_EQ(scheduler.next_wake(first_tick - 1ms), first_tick);
  ASSERT_TRUE(pulse(first_tick));
  EXPECT_FALSE(scheduler.tick_due(tick(1) - moment));
  EXPECT_TRUE(scheduler.tick_due(tick(1)));
}

TEST_F(VolumeSchedulerTest, a_late_tick_delays_none_after_it) {
  ASSERT_TRUE(pulse(first_tick + plan.tick_period() / 2));
  EXPECT_FALSE(scheduler.tick_due(tick(1) - moment));
  EXPECT_TRUE(scheduler.tick_due(tick(1)));
}

TEST_F(VolumeSchedulerTest, ticks_that_were_slept_through_are_lost_volumes) {
  EXPECT_EQ(scheduler.tick(tick(1) - moment).slept_through, 0U);
  const TickDecision decision = scheduler.tick(tick(4)); // that of 1 is done late; 2 to 4 are gone
  EXPECT_EQ(decision.slept_through, 3U);
  EXPECT_TRUE(decision.pulse);
  EXPECT_FALSE(scheduler.tick_due(tick(5) - moment));
  EXPECT_TRUE(scheduler.tick_due(tick(5)));
  const VolumeCounters counters = scheduler.counters();
  EXPECT_EQ(counters.planned, 3U);
  EXPECT_EQ(counters.lost_volumes, 3U);
  EXPECT_EQ(counters.lost_b_scans, 3U * 8);
  EXPECT_EQ(counters.lost_lines, 3U * 8 * 4);
  EXPECT_EQ(counters.triggered, 0U);
}

TEST_F(VolumeSchedulerTest, a_pulse_that_fails_loses_its_volume) {
  scheduler.tick(first_tick);
  scheduler.pulse_failed();
  EXPECT_EQ(scheduler.counters().planned, 1U);
  EXPECT_EQ(scheduler.counters().lost_volumes, 1U);
  EXPECT_EQ(scheduler.counters().triggered, 0U);
  EXPECT_EQ(next(first_tick + 1s).action, Action::wait) << "nothing is under way";
}

TEST_F(VolumeSchedulerTest, nothing_is_lost_without_a_camera_until_it_has_streamed_once) {
  scheduler.tick(first_tick);
  scheduler.not_ready();
  EXPECT_EQ(scheduler.counters().planned, 0U);
  EXPECT_EQ(scheduler.counters().lost_volumes, 0U);
  ASSERT_TRUE(pulse(tick(1)));
  scheduler.tick(tick(2));
  scheduler.not_ready();
  EXPECT_EQ(scheduler.counters().planned, 2U);
  EXPECT_EQ(scheduler.counters().lost_volumes, 1U);
}

TEST_F(VolumeSchedulerTest, a_pulse_while_the_workers_are_three_volumes_behind_is_lost) {
  std::vector<std::uint32_t> buffers;
  for (int n = 0; n < 3; ++n) {
    buffers.push_back(pulse(tick(n)).value());
    for (int sweep = 0; sweep < 8; ++sweep)
      frame(tick(n), sweep); // and nobody makes them
  }
  std::ranges::sort(buffers);
  EXPECT_EQ(buffers, (std::vector<std::uint32_t>{2, 3, 4})) << "0 and 1 are the renderer's";
  EXPECT_FALSE(pulse(tick(3)));
  EXPECT_EQ(frame(tick(3), 0).verdict, FrameVerdict::late) << "a frame of the lost one";
  EXPECT_EQ(scheduler.counters().planned, 4U);
  EXPECT_EQ(scheduler.counters().triggered, 4U);
  EXPECT_EQ(scheduler.counters().lost_volumes, 1U);
  EXPECT_EQ(next(tick(4) - moment).action, Action::wait) << "for the workers";
}

TEST_F(VolumeSchedulerTest, a_frame_is_submitted_as_it_comes_and_in_its_place) {
  const std::uint32_t buffer = pulse(first_tick).value();
  for (const int sweep : {3, 1, 0, 2, 7, 6, 5, 4}) { // the time decides, not the order
    const FrameDecision decision = frame(first_tick, sweep);
    EXPECT_EQ(decision.verdict, FrameVerdict::placed);
    EXPECT_EQ(decision.buffer, buffer);
    EXPECT_EQ(decision.b_scan, sweep);
    EXPECT_EQ(decision.repeat, 0);
    EXPECT_EQ(jobs(decision.submit), (std::vector<BScanJob>{{buffer, sweep}}));
  }
}

TEST_F(VolumeSchedulerTest, a_whole_volume_is_published_as_soon_as_its_b_scans_are_made) {
  const std::uint32_t buffer = pulse(first_tick).value();
  deliver(first_tick, 0, 7);
  EXPECT_EQ(next(time_of(first_tick, 7)).action, Action::wait);
  EXPECT_EQ(frame(first_tick, 7).submit.size(), 1U);
  const hal::TimePoint now = time_of(first_tick, 8);
  EXPECT_EQ(next(now).action, Action::wait) << "the last one is being made";
  scheduler.b_scan_made(buffer);
  const VolumeDecision decision = next(now);
  EXPECT_EQ(decision.action, Action::publish);
  EXPECT_EQ(decision.buffer, buffer);
  EXPECT_EQ(decision.volume.number, 1U);
  EXPECT_EQ(decision.volume.first_line, first_tick);
  EXPECT_EQ(decision.volume.last_line, time_of(first_tick, 7) + 800us);
  EXPECT_EQ(decision.volume.lost_b_scans, 0);
  EXPECT_EQ(decision.volume.lost_lines, 0);
  scheduler.published(0, false);
  EXPECT_EQ(next(now).action, Action::wait);
  EXPECT_EQ(scheduler.counters().acquired, 1U);
  EXPECT_EQ(scheduler.counters().published, 1U);
  EXPECT_EQ(scheduler.counters().skipped, 0U);
  EXPECT_EQ(pulse(tick(1)), 0U) << "what came back is built in";
}

TEST_F(VolumeSchedulerTest, a_volume_that_nobody_took_is_skipped) {
  for (int n = 0; n < 2; ++n) {
    const std::uint32_t buffer = pulse(tick(n)).value();
    deliver(tick(n), 0, 8);
    ASSERT_EQ(next(tick(n + 1) - moment).action, Action::publish);
    scheduler.published(buffer, n == 1);
  }
  EXPECT_EQ(scheduler.counters().published, 2U);
  EXPECT_EQ(scheduler.counters().skipped, 1U);
}

TEST_F(VolumeSchedulerTest, missing_frames_are_waited_for_until_the_volumes_time_is_over) {
  const std::uint32_t buffer = pulse(first_tick).value();
  deliver(first_tick, 0, 2);
  deliver(first_tick, 3, 7);
  EXPECT_EQ(next(accepts_until(first_tick) - moment).action, Action::wait);
  const VolumeDecision decision = next(accepts_until(first_tick));
  EXPECT_EQ(decision.action, Action::publish);
  EXPECT_EQ(decision.buffer, buffer);
  EXPECT_EQ(decision.volume.lost_b_scans, 2);
  EXPECT_EQ(decision.volume.lost_lines, 2 * 4);
  EXPECT_EQ(scheduler.counters().lost_b_scans, 2U);
  EXPECT_EQ(scheduler.counters().lost_lines, 2U * 4);
  EXPECT_EQ(scheduler.counters().lost_volumes, 0U);
}

TEST_F(VolumeSchedulerTest, a_frame_that_comes_just_in_time_makes_the_volume_whole) {
  pulse(first_tick);
  deliver(first_tick, 0, 7);
  ASSERT_EQ(next(accepts_until(first_tick) - moment).action, Action::wait);
  deliver(first_tick, 7, 8);
  const VolumeDecision decision = next(accepts_until(first_tick) - moment);
  EXPECT_EQ(decision.action, Action::publish);
  EXPECT_EQ(decision.volume.lost_b_scans, 0);
}

TEST_F(VolumeSchedulerTest, a_volume_of_which_nothing_came_is_lost) {
  const std::uint32_t buffer = pulse(first_tick).value();
  EXPECT_EQ(next(accepts_until(first_tick) - moment).action, Action::wait);
  const VolumeDecision decision = next(accepts_until(first_tick));
  EXPECT_EQ(decision.action, Action::lose);
  EXPECT_EQ(decision.buffer, buffer);
  EXPECT_EQ(scheduler.counters().lost_volumes, 1U);
  EXPECT_EQ(scheduler.counters().lost_b_scans, 8U);
  EXPECT_EQ(scheduler.counters().lost_lines, 8U * 4);
  EXPECT_EQ(scheduler.counters().acquired, 0U);
  EXPECT_EQ(pulse(tick(2) - moment), buffer) << "it is free again";
}

TEST_F(VolumeSchedulerTest, a_camera_not_looked_at_is_waited_for_but_not_for_ever) {
  pulse(first_tick);
  deliver(first_tick, 0, 5);
  const hal::TimePoint over = accepts_until(first_tick) + 10us; // the thread wakes a little later
  const hal::TimePoint unlooked = accepts_until(first_tick) - moment;
  const VolumeDecision decision = scheduler.next(over, unlooked, true);
  EXPECT_EQ(decision.action, Action::look);
  EXPECT_EQ(decision.look_until, accepts_until(first_tick));
  EXPECT_EQ(scheduler.next(over, unlooked, true).action, Action::wait) << "it is asked once";
  EXPECT_EQ(scheduler.next(over + patience() - moment, unlooked, true).action, Action::wait);
  const VolumeDecision last = scheduler.next(over + patience(), unlooked, true);
  EXPECT_EQ(last.action, Action::publish);
  EXPECT_EQ(last.volume.lost_b_scans, 3);
}

TEST_F(VolumeSchedulerTest, what_a_late_look_brings_is_not_late) {
  pulse(first_tick);
  deliver(first_tick, 0, 5);
  const hal::TimePoint over = accepts_until(first_tick);
  ASSERT_EQ(next_unlooked(over).action, Action::look);
  deliver(first_tick, 5, 8);
  const VolumeDecision decision = next_unlooked(over + patience() / 2);
  EXPECT_EQ(decision.action, Action::publish);
  EXPECT_EQ(decision.volume.lost_b_scans, 0);
}

TEST_F(VolumeSchedulerTest, a_look_that_brings_nothing_ends_the_wait) {
  pulse(first_tick);
  deliver(first_tick, 0, 5);
  const hal::TimePoint over = accepts_until(first_tick);
  ASSERT_EQ(next_unlooked(over).action, Action::look);
  EXPECT_EQ(scheduler.next(over + 1ms, over, true).action, Action::publish);
}

TEST_F(VolumeSchedulerTest, a_camera_that_does_not_stream_is_not_waited_for) {
  pulse(first_tick);
  deliver(first_tick, 0, 5);
  EXPECT_EQ(scheduler.next(accepts_until(first_tick) - moment, {}, false).action, Action::wait);
  EXPECT_EQ(scheduler.next(accepts_until(first_tick), {}, false).action, Action::publish);
}

TEST_F(VolumeSchedulerTest, each_volume_asks_for_a_look_of_its_own) {
  for (int n = 0; n < 2; ++n) {
    const std::uint32_t buffer = pulse(tick(2 * n)).value();
    deliver(tick(2 * n), 0, 5);
    const VolumeDecision decision = next_unlooked(accepts_until(tick(2 * n)));
    ASSERT_EQ(decision.action, Action::look) << n;
    EXPECT_EQ(decision.look_until, accepts_until(tick(2 * n)));
    ASSERT_EQ(next(accepts_until(tick(2 * n))).action, Action::publish);
    scheduler.published(buffer, false);
    scheduler.tick(tick(2 * n + 1));
    scheduler.not_ready();
  }
}

TEST_F(VolumeSchedulerTest, volumes_are_published_in_order) {
  const std::uint32_t first = pulse(tick(0)).value();
  deliver(tick(0), 0, 7);
  frame(tick(0), 7);
  const std::uint32_t second = pulse(tick(1)).value();
  deliver(tick(1), 0, 8);
  EXPECT_EQ(next(tick(2) - moment).action, Action::wait) << "the second is whole, the first is not";
  scheduler.b_scan_made(first);
  VolumeDecision decision = next(tick(2) - moment);
  EXPECT_EQ(decision.action, Action::publish);
  EXPECT_EQ(decision.buffer, first);
  scheduler.published(0, false);
  decision = next(tick(2) - moment);
  EXPECT_EQ(decision.action, Action::publish);
  EXPECT_EQ(decision.buffer, second);
  EXPECT_EQ(decision.volume.number, 2U);
}

TEST_F(VolumeSchedulerTest, frames_without_a_place_are_refused_and_change_nothing) {
  const std::uint32_t buffer = pulse(first_tick).value();
  EXPECT_EQ(frame(first_tick, -1).verdict, FrameVerdict::outside);
  EXPECT_EQ(frame(first_tick, 9).verdict, FrameVerdict::outside);
  deliver(first_tick, 0, 3);
  const FrameDecision doubled = frame(first_tick, 1);
  EXPECT_EQ(doubled.verdict, FrameVerdict::doubled);
  EXPECT_TRUE(doubled.submit.empty());
  const VolumeDecision decision = next(accepts_until(first_tick));
  ASSERT_EQ(decision.action, Action::publish);
  EXPECT_EQ(decision.volume.lost_b_scans, 5) << "three came, each once";
  EXPECT_EQ(decision.volume.last_line, time_of(first_tick, 2) + 800us);
  scheduler.published(buffer, false);
  const FrameDecision late = frame(first_tick, 4);
  EXPECT_EQ(late.verdict, FrameVerdict::late) << "its volume is over";
  EXPECT_TRUE(late.submit.empty());
  EXPECT_EQ(scheduler.counters().lost_b_scans, 5U);
}

TEST_F(VolumeSchedulerTest, a_frame_belongs_to_the_sweep_that_is_nearest) {
  pulse(first_tick);
  const hal::TimePoint third = time_of(first_tick, 3);
  EXPECT_EQ(scheduler.place(third + 499us, third + 1ms).b_scan, 3);
  EXPECT_EQ(frame(first_tick, -1).verdict, FrameVerdict::outside);
}

TEST_F(VolumeSchedulerTest, what_is_under_way_at_the_end_is_unfinished) {
  pulse(tick(0));
  deliver(tick(0), 0, 8);
  pulse(tick(1));
  scheduler.end();
  EXPECT_EQ(scheduler.counters().unfinished, 2U);
  EXPECT_EQ(scheduler.counters().planned, 2U);
}

TEST_F(VolumeSchedulerTest, it_wakes_for_ticks_and_for_the_oldest_volumes_end) {
  pulse(first_tick);
  EXPECT_EQ(scheduler.next_wake(first_tick), tick(1));
  pulse(tick(1));
  EXPECT_EQ(scheduler.next_wake(tick(1)), accepts_until(first_tick));
  const hal::TimePoint over = accepts_until(first_tick) + 10us;
  ASSERT_EQ(next_unlooked(over).action, Action::look);
  EXPECT_EQ(scheduler.next_wake(over), over + patience());
  EXPECT_EQ(scheduler.next_wake(over + patience()), over + patience() + 100us)
      << "a moment at least";
  ASSERT_EQ(next(over).action, Action::lose);
  EXPECT_EQ(scheduler.next_wake(over), tick(2));
}

TEST(VolumeScheduler, shows_life_twice_a_second_however_slow_the_scan_is) {
  ScanPlan plan = short_plan();
  plan.line_rate_hz = 10;
  VolumeScheduler scheduler{plan, std::nullopt};
  scheduler.begin(first_tick);
  scheduler.tick(first_tick);
  scheduler.pulsed(first_tick);
  EXPECT_EQ(scheduler.next_wake(first_tick + 1s), first_tick + 1500ms);
}

class TwoVolumesTest : public VolumeSchedulerTest {
protected:
  TwoVolumesTest() : VolumeSchedulerTest(short_plan(), 2) {}
};

TEST_F(TwoVolumesTest, no_more_are_asked_for_but_what_was_lost_is_made_up_for) {
  pulse(tick(0));
  pulse(tick(1));
  EXPECT_FALSE(scheduler.tick(tick(2)).pulse) << "two are under way";
  ASSERT_EQ(next(accepts_until(tick(1))).action, Action::lose);
  EXPECT_TRUE(scheduler.tick(tick(3)).pulse);
  const std::uint32_t third = scheduler.pulsed(tick(3)).value();
  EXPECT_FALSE(scheduler.tick(tick(4)).pulse);
  deliver(tick(3), 0, 8);
  ASSERT_EQ(next(tick(5) - moment).action, Action::lose) << "the second";
  ASSERT_EQ(next(tick(5) - moment).action, Action::publish);
  scheduler.published(third, false);
  EXPECT_TRUE(scheduler.tick(tick(5)).pulse) << "one is missing yet";
  EXPECT_EQ(scheduler.counters().planned, 3U) << "what was not asked for was not planned";
}

ScanPlan three_repeats() {
  ScanPlan plan = short_plan();
  plan.repeats = 3;
  plan.b_scans = 4;
  return plan;
}

class RepeatedSweepsTest : public VolumeSchedulerTest {
protected:
  RepeatedSweepsTest() : VolumeSchedulerTest(three_repeats()) {}

  // What each sweep's frame has submitted, by B-scan.
  std::vector<int> submitted_by(int sweep) {
    const FrameDecision decision = frame(first_tick, sweep);
    EXPECT_EQ(decision.verdict, FrameVerdict::placed) << sweep;
    EXPECT_EQ(decision.b_scan, sweep / 3);
    EXPECT_EQ(decision.repeat, sweep % 3);
    make(decision.submit);
    std::vector<int> b_scans;
    for (const BScanJob& job : decision.submit)
      b_scans.push_back(job.b_scan);
    return b_scans;
  }
};

TEST_F(RepeatedSweepsTest, a_b_scan_is_made_when_all_its_sweeps_have_come) {
  pulse(first_tick);
  for (int sweep = 0; sweep < 12; ++sweep)
    EXPECT_EQ(submitted_by(sweep),
              sweep % 3 == 2 ? std::vector<int>{sweep / 3} : std::vector<int>{});
  EXPECT_EQ(next(time_of(first_tick, 12)).action, Action::publish);
}

TEST_F(RepeatedSweepsTest, one_that_misses_some_is_made_when_the_b_scan_after_the_next_begins) {
  pulse(first_tick);
  for (const int sweep : {0, 2, 3, 4}) // B-scan 0 lacks its middle, 1 its last
    EXPECT_EQ(submitted_by(sweep), std::vector<int>{});
  EXPECT_EQ(submitted_by(6), std::vector<int>{0});
  EXPECT_EQ(frame(first_tick, 1).verdict, FrameVerdict::late) << "its B-scan was made";
  EXPECT_EQ(submitted_by(5), std::vector<int>{1}) << "in time";
  EXPECT_EQ(submitted_by(9), std::vector<int>{});
  EXPECT_EQ(submitted_by(7), std::vector<int>{});
  EXPECT_EQ(submitted_by(8), std::vector<int>{2});
  EXPECT_EQ(frame(first_tick, 8).verdict, FrameVerdict::doubled);
}

TEST_F(RepeatedSweepsTest, a_jump_ahead_makes_all_that_was_left_behind) {
  pulse(first_tick);
  EXPECT_EQ(submitted_by(0), std::vector<int>{});
  EXPECT_EQ(submitted_by(4), std::vector<int>{});
  EXPECT_EQ(submitted_by(11), (std::vector<int>{0, 1}));
}

TEST_F(RepeatedSweepsTest, a_b_scan_that_was_passed_over_is_made_from_the_first_sweep_that_comes) {
  pulse(first_tick);
  EXPECT_EQ(submitted_by(6), std::vector<int>{}) << "nothing has come of B-scan 0";
  EXPECT_EQ(submitted_by(3), std::vector<int>{}) << "1 may still be whole";
  EXPECT_EQ(submitted_by(1), std::vector<int>{0});
  EXPECT_EQ(frame(first_tick, 2).verdict, FrameVerdict::late);
}

TEST_F(RepeatedSweepsTest, at_the_volumes_end_the_rest_is_made_and_then_published) {
  const std::uint32_t buffer = pulse(first_tick).value();
  // B-scan 0 lacks its middle, 1 has one only, 2 has none, 3 lacks its last.
  for (const int sweep : {0, 2, 4, 9, 10})
    submitted_by(sweep);
  EXPECT_EQ(next(accepts_until(first_tick) - moment).action, Action::wait);
  const VolumeDecision decision = next(accepts_until(first_tick));
  ASSERT_EQ(decision.action, Action::submit);
  EXPECT_EQ(jobs(decision.submit), (std::vector<BScanJob>{{buffer, 3}}));
  EXPECT_EQ(next(accepts_until(first_tick)).action, Action::wait) << "it is being made";
  EXPECT_EQ(frame(first_tick, 11).verdict, FrameVerdict::late);
  scheduler.b_scan_made(buffer);
  const VolumeDecision end = next(accepts_until(first_tick));
  ASSERT_EQ(end.action, Action::publish);
  EXPECT_EQ(end.volume.lost_b_scans, 1);
  EXPECT_EQ(end.volume.lost_lines, 7 * 4);
}

ScanPlan there_and_back() {
  ScanPlan plan = short_plan();
  plan.bidirectional = true;
  plan.turn_around_lines = 6; // ten lines a sweep: 2 ms
  return plan;
}

class ThereAndBackTest : public VolumeSchedulerTest {
protected:
  ThereAndBackTest() : VolumeSchedulerTest(there_and_back()) {}
};

TEST_F(ThereAndBackTest, sweeps_last_as_long_as_their_turn_around) {
  const std::uint32_t buffer = pulse(first_tick).value();
  for (int sweep = 0; sweep < 7; ++sweep) {
    const FrameDecision decision =
        scheduler.place(first_tick + sweep * 2ms, first_tick + sweep * 2ms + 1900us);
    EXPECT_EQ(jobs(decision.submit), (std::vector<BScanJob>{{buffer, sweep}}));
    make(decision.submit);
  }
  constexpr hal::Duration sweeps = 16ms;
  const hal::TimePoint over = first_tick + sweeps + sweeps / 6;
  EXPECT_EQ(next(over - moment).action, Action::wait);
  const VolumeDecision decision = next(over);
  EXPECT_EQ(decision.action, Action::publish);
  EXPECT_EQ(decision.volume.lost_lines, 4) << "the kept ones";
  EXPECT_FALSE(scheduler.tick_due(first_tick + sweeps));
  EXPECT_TRUE(scheduler.tick_due(first_tick + sweeps + sweeps / 500));
}

TEST_F(RepeatedSweepsTest, a_volumes_whole_life_allocates_nothing) {
  const std::uint64_t before = tests::allocations_of_this_thread();
  for (int n = 0; n < 10; ++n) {
    const std::uint32_t buffer = pulse(tick(2 * n)).value();
    for (const int sweep : {0, 1, 2, 4, 9, 9, 10})
      make(frame(tick(2 * n), sweep).submit);
    next_unlooked(accepts_until(tick(2 * n)));
    make(next(accepts_until(tick(2 * n))).submit);
    EXPECT_EQ(next(accepts_until(tick(2 * n))).action, Action::publish);
    scheduler.published(buffer, false);
    scheduler.tick(tick(2 * n + 1));
    scheduler.pulse_failed();
  }
  EXPECT_EQ(tests::allocations_of_this_thread(), before);
}

} // namespace
} // namespace octascope::pipeline
