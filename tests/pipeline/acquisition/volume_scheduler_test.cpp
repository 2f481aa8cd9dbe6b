// Every decision of the fixed-rate thread, by explicit times: no clock, no thread, no sleep.
#include "tests/pipeline/acquisition/volume_scheduler_fixture.h"

namespace octascope::pipeline {
namespace {

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

// What a recording keeps as the index: its gaps tell of pauses.
TEST_F(VolumeSchedulerTest, a_volumes_number_counts_the_ticks_that_brought_none) {
  const auto number_at = [&](int n) {
    const std::uint32_t buffer = scheduler.pulsed(tick(n)).value();
    deliver(tick(n), 0, 8);
    const VolumeDecision decision = next(tick(n + 1) - moment);
    EXPECT_EQ(decision.action, Action::publish);
    scheduler.published(buffer, false);
    return decision.volume.number;
  };
  EXPECT_EQ(scheduler.tick(tick(0)).slept_through, 0U);
  scheduler.not_ready(); // nothing was planned before the camera streams
  scheduler.tick(tick(1));
  EXPECT_EQ(number_at(1), 1U);
  EXPECT_EQ(scheduler.tick(tick(22)).slept_through, 20U);
  EXPECT_EQ(number_at(22), 22U);
  scheduler.tick(tick(23));
  scheduler.not_ready();
  scheduler.tick(tick(24));
  scheduler.pulse_failed();
  scheduler.tick(tick(25));
  EXPECT_EQ(number_at(25), 25U);
  const VolumeCounters counters = scheduler.counters();
  EXPECT_EQ(counters.planned, 25U);
  EXPECT_EQ(counters.lost_volumes, 22U);
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

TEST_F(VolumeSchedulerTest, who_made_a_b_scan_wakes_the_thread_only_where_nothing_else_is_awaited) {
  const std::uint32_t buffer = pulse(first_tick).value();
  for (int sweep = 0; sweep < 8; ++sweep) {
    EXPECT_EQ(frame(first_tick, sweep).submit.size(), 1U);
    EXPECT_EQ(next(time_of(first_tick, sweep)).action, Action::wait);
    if (sweep < 6) {
      EXPECT_FALSE(scheduler.b_scan_made(buffer)) << "more frames come";
    }
  }
  EXPECT_TRUE(scheduler.b_scan_made(buffer));
  EXPECT_EQ(next(time_of(first_tick, 8)).action, Action::wait);
  EXPECT_TRUE(scheduler.b_scan_made(buffer));
  EXPECT_EQ(next(time_of(first_tick, 8)).action, Action::publish);
  scheduler.published(0, false);
  EXPECT_EQ(pulse(tick(1)), 0U);
  frame(tick(1), 0);
  EXPECT_FALSE(scheduler.b_scan_made(0)) << "of the next volume in the same buffer";
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

TEST_F(VolumeSchedulerTest, nothing_is_built_of_a_volume_that_is_passed_over) {
  ASSERT_TRUE(scheduler.tick(first_tick).pulse);
  scheduler.pass_over(first_tick);
  EXPECT_FALSE(scheduler.is_building());
  for (int sweep = 0; sweep < plan.b_scans; ++sweep) {
    const FrameDecision decision = frame(first_tick, sweep);
    EXPECT_EQ(decision.verdict, FrameVerdict::passed_over);
    EXPECT_TRUE(decision.submit.empty());
  }
  EXPECT_EQ(frame(first_tick, 3).verdict, FrameVerdict::doubled);
  EXPECT_EQ(next(time_of(first_tick, 8)).action, Action::pass);
  EXPECT_EQ(next(time_of(first_tick, 8)).action, Action::wait);
  EXPECT_EQ(scheduler.counters().passed_over, 1U);
  EXPECT_EQ(scheduler.counters().acquired, 0U);
  EXPECT_EQ(scheduler.counters().lost_lines, 0U);
}

// Workers may need long for the one before.
TEST_F(VolumeSchedulerTest, a_volume_that_is_passed_over_waits_for_none_that_is_built) {
  pulse(first_tick);
  for (int sweep = 0; sweep < plan.b_scans; ++sweep)
    frame(first_tick, sweep); // none of which is made
  ASSERT_TRUE(scheduler.tick(tick(1)).pulse);
  scheduler.pass_over(tick(1));
  for (int sweep = 0; sweep < plan.b_scans; ++sweep)
    frame(tick(1), sweep);
  EXPECT_EQ(next(tick(2)).action, Action::pass);
  EXPECT_TRUE(scheduler.is_building());
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
  EXPECT_EQ(scheduler.next_wake(tick(2) + 1us), over + patience())
      << "what came due since it was asked about is not put off";
  ASSERT_EQ(next(over).action, Action::lose);
  EXPECT_EQ(scheduler.next_wake(over), tick(2));
}

TEST_F(VolumeSchedulerTest, a_tick_that_comes_due_before_the_wait_is_not_put_off) {
  pulse(first_tick);
  deliver(first_tick, 0, 8);
  EXPECT_EQ(scheduler.next_wake(tick(1) + 1us), tick(1));
}

TEST_F(VolumeSchedulerTest, a_volume_that_only_the_workers_hold_up_wakes_nobody) {
  pulse(first_tick);
  deliver(first_tick, 1, 8);
  ASSERT_EQ(frame(first_tick, 0).submit.size(), 1U);
  pulse(tick(1));
  const hal::TimePoint over = accepts_until(first_tick);
  ASSERT_EQ(next(over).action, Action::wait) << "nobody has made the first B-scan";
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

} // namespace
} // namespace octascope::pipeline
