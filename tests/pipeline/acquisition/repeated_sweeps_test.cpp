// The same of sweeps that are repeated, and of those there and back.
#include "tests/pipeline/acquisition/volume_scheduler_fixture.h"
#include "tests/support/allocation_counter.h"

namespace octascope::pipeline {
namespace {

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
