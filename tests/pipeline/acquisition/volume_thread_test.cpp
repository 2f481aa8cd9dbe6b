// The fixed-rate thread with its devices' threads: that it does what the scheduler decides
// (volume_scheduler_test.cpp), in the time of its clock.
#include <algorithm>
#include <array>
#include <vector>

#include "tests/pipeline/acquisition/volume_thread_stage.h"

namespace octascope::pipeline {
namespace {

TEST_F(VolumeThreadTest, publishes_a_whole_volume_with_every_b_scan_in_its_place) {
  start();
  const hal::TimePoint pulsed = trigger.wait_for_pulse(0);
  // In any order: the timestamp decides.
  for (const int b : {3, 1, 0, 2, 7, 6, 5, 4})
    camera.deliver(static_cast<std::uint64_t>(b), time_of(pulsed, b),
                   static_cast<std::uint8_t>(10 + b));
  const Volume* volume = wait_for_volume(1);
  for (int b = 0; b < plan.b_scans; ++b) {
    EXPECT_EQ(volume->b_scan_states[static_cast<std::size_t>(b)], BScanState::good);
    for (const std::uint8_t level : volume->b_scan(b))
      ASSERT_EQ(level, 10 + b);
  }
  EXPECT_EQ(volume->metadata.pulsed, pulsed);
  EXPECT_EQ(volume->metadata.last_line, time_of(pulsed, 7) + 100us);
  EXPECT_EQ(volume->metadata.published, pulsed) << "no time has passed";
  EXPECT_EQ(volume->metadata.lost_b_scans, 0);
  stop();
  EXPECT_EQ(volumes->counters().published, 1U);
  EXPECT_EQ(volumes->counters().lost_b_scans, 0U);
}

// A renderer that draws the first volume while the second one begins.
class RightOfWayTest : public VolumeThreadTest {
protected:
  // The first is published 1 ms before the second one's pulse; of that one, so many frames come.
  void begin_second_volume(std::uint64_t frames) {
    start();
    const hal::TimePoint first = trigger.wait_for_pulse(0);
    deliver(first, 0, plan.b_scans - 1);
    await_frames(7);
    clock.sleep_until(first + plan.tick_period() - 1ms);
    deliver(first, plan.b_scans - 1, plan.b_scans);
    wait_for_volume(1);
    published = clock.now();
    clock.sleep_until(first + plan.tick_period());
    const hal::TimePoint second = trigger.wait_for_pulse(1);
    for (std::uint64_t b = 0; b < frames; ++b)
      camera.deliver(8 + b, time_of(second, static_cast<int>(b)), 20);
    await_frames(8 + frames);
  }

  bool are_built() const { return acquisition->on_loan() == 0; }
  // For as long as a test can wait for what is not to come.
  void expect_nothing_built(int frames) const {
    std::this_thread::sleep_for(30ms);
    EXPECT_EQ(acquisition->on_loan(), frames);
  }

  hal::TimePoint published;
};

TEST_F(RightOfWayTest, workers_begin_at_once_where_nobody_wants_it) {
  begin_second_volume(3);
  await([&] { return are_built(); });
  stop();
}

TEST_F(RightOfWayTest, workers_begin_when_the_volume_is_drawn) {
  volumes->expect(Showing::whole);
  begin_second_volume(3);
  expect_nothing_built(3);
  volumes->note_drawn();
  arrived.post(); // as the next frame would
  await([&] { return are_built(); });
  stop();
}

TEST_F(RightOfWayTest, workers_begin_after_a_while_whatever_becomes_of_the_volume) {
  volumes->expect(Showing::whole);
  begin_second_volume(3);
  expect_nothing_built(3);
  clock.sleep_until(published + 100ms);
  await([&] { return are_built(); });
  stop();
}

// Of those that the driver gave it, not of those that it was asked for.
TEST_F(RightOfWayTest, workers_leave_the_camera_half_of_its_buffers) {
  camera.give_fewer_buffers(8);
  volumes->expect(Showing::whole);
  begin_second_volume(4);
  await([&] { return 2 * acquisition->on_loan() < 8; });
  stop();
}

// The volume in the making, as far as it is made, and when each B-scan was exposed.
TEST_F(VolumeThreadTest, lends_what_is_finished_of_a_volume_in_the_making) {
  start();
  const hal::TimePoint pulsed = trigger.wait_for_pulse(0);
  const auto progress_of = [this](int b) {
    const auto making = volumes->borrow_after(0);
    volumes->give_back();
    return making ? making->progress[static_cast<std::size_t>(b)].load() : BScanProgress::awaited;
  };
  deliver(pulsed, 0, 2);
  await([&] { return progress_of(0) == BScanProgress::finished; });
  EXPECT_EQ(progress_of(1), BScanProgress::awaited) << "its neighbour has not come";
  EXPECT_EQ(progress_of(2), BScanProgress::awaited);
  deliver(pulsed, 3, 5); // without number 2
  // By any worker, in any order; nobody waits for the neighbour of number 1.
  await([&] {
    return progress_of(1) == BScanProgress::finished && progress_of(2) == BScanProgress::overdue &&
           progress_of(3) == BScanProgress::finished;
  });
  const auto making = volumes->borrow_after(0);
  ASSERT_TRUE(making);
  EXPECT_EQ(making->number, 1U);
  EXPECT_EQ(making->volume->b_scan(3)[0], 10);
  EXPECT_EQ(making->volume->work[3].first_line, time_of(pulsed, 3));
  EXPECT_EQ(making->volume->work[3].last_line, time_of(pulsed, 3) + 100us);
  volumes->give_back();
  EXPECT_FALSE(volumes->borrow_after(1)) << "there is no later one";
  deliver(pulsed, 5, plan.b_scans);
  await_frames(static_cast<std::uint64_t>(plan.b_scans) - 1);
  clock.sleep_until(accepts_until(pulsed));
  const Volume* volume = wait_for_volume(1);
  EXPECT_EQ(volume->b_scan_states[2], BScanState::missing);
  EXPECT_EQ(volume->metadata.lost_b_scans, 1);
  stop();
}

TEST_F(VolumeThreadTest, publishes_without_the_missing_and_broken_ones_and_counts_them) {
  start();
  const hal::TimePoint pulsed = trigger.wait_for_pulse(0);
  for (const int b : {0, 1, 3, 4, 5, 6}) // 2 and 7 never come, 5 is broken, 6 is saturated
    camera.deliver(static_cast<std::uint64_t>(b), time_of(pulsed, b),
                   b == 6 ? saturated_fill : static_cast<std::uint8_t>(10 + b),
                   b == 5 ? FrameIntegrity::corrupted : FrameIntegrity::good);
  await_frames(5);
  clock.sleep_until(accepts_until(pulsed));
  const Volume* volume = wait_for_volume(1);
  for (const int b : {2, 5, 7}) {
    EXPECT_EQ(volume->b_scan_states[static_cast<std::size_t>(b)], BScanState::missing);
    for (const std::uint8_t level : volume->b_scan(b))
      ASSERT_EQ(level, 0);
  }
  EXPECT_EQ(volume->b_scan_states[6], BScanState::saturated);
  EXPECT_EQ(volume->metadata.lost_b_scans, 3);
  EXPECT_EQ(volume->metadata.lost_lines, 12);
  EXPECT_EQ(volume->metadata.saturated_lines, 3);
  EXPECT_TRUE(has_fault(Fault::corrupted_frame));
  stop();
  const VolumeCounters counters = volumes->counters();
  EXPECT_EQ(counters.planned, 2U);
  EXPECT_EQ(counters.unfinished, 1U) << "the next one had begun";
  EXPECT_EQ(counters.lost_b_scans, 3U);
  EXPECT_EQ(counters.lost_lines, 12U);
  EXPECT_EQ(counters.saturated_lines, 3U);
  EXPECT_EQ(acquisition->counters().gaps, 1U);
  EXPECT_EQ(acquisition->counters().unusable, 1U);
}

TEST_F(VolumeThreadTest, a_late_frame_of_a_published_volume_is_refused) {
  start();
  const hal::TimePoint pulsed = trigger.wait_for_pulse(0);
  deliver(pulsed, 0, 1);
  await_frames(1);
  clock.sleep_until(accepts_until(pulsed));
  wait_for_volume(1);
  camera.deliver(1, time_of(pulsed, 1), 99);
  await([&] { return has_fault(Fault::late_frame); });
  stop();
}

TEST_F(VolumeThreadTest, frames_that_came_in_time_to_a_camera_nobody_looked_at_are_not_late) {
  start();
  const hal::TimePoint pulsed = trigger.wait_for_pulse(0);
  deliver(pulsed, 0, 5);
  hold_camera_after(5);
  deliver(pulsed, 5, plan.b_scans);
  clock.sleep_until(accepts_until(pulsed));
  EXPECT_EQ(clock.await_waiter(), accepts_until(pulsed) + patience());
  EXPECT_FALSE(volumes->has_newer());
  camera.let_go();
  const Volume* volume = wait_for_volume(1);
  EXPECT_EQ(volume->metadata.index, 1U);
  EXPECT_EQ(volume->missing_b_scans(), 0);
  EXPECT_FALSE(has_fault(Fault::late_frame));
  stop();
}

TEST_F(VolumeThreadTest, a_volume_does_not_wait_for_ever_for_a_look_at_the_camera) {
  start();
  const hal::TimePoint pulsed = trigger.wait_for_pulse(0);
  deliver(pulsed, 0, 5);
  hold_camera_after(5);
  clock.sleep_until(accepts_until(pulsed));
  EXPECT_EQ(clock.await_waiter(), accepts_until(pulsed) + patience());
  EXPECT_FALSE(volumes->has_newer());
  clock.sleep_until(accepts_until(pulsed) + patience());
  const Volume* volume = wait_for_volume(1);
  EXPECT_EQ(volume->metadata.index, 1U);
  EXPECT_EQ(volume->missing_b_scans(), 3);
  camera.let_go();
  stop();
}

// Two seconds of ticks, made in a moment.
TEST_F(VolumeThreadTest, pulses_at_the_ticks_of_its_clock_and_waits_in_its_time) {
  const hal::TimePoint begin = clock.now();
  start();
  while (trigger.pulses() < 6)
    clock.sleep_until(clock.await_waiter());
  for (int n = 0; n < 6; ++n)
    ASSERT_EQ(trigger.wait_for_pulse(static_cast<std::size_t>(n)), begin + n * plan.tick_period());
  EXPECT_FALSE(has_fault(Fault::late_tick));
  stop();
  EXPECT_EQ(volumes->counters().planned, trigger.pulses());
  EXPECT_EQ(volumes->counters().acquired, 0U);
  EXPECT_TRUE(has_fault(Fault::missed_pulse));
}

TEST_F(VolumeThreadTest, a_stuck_sequence_number_moves_no_b_scan) {
  start();
  const hal::TimePoint pulsed = trigger.wait_for_pulse(0);
  for (int b = 0; b < plan.b_scans; ++b)
    camera.deliver(5, time_of(pulsed, b), static_cast<std::uint8_t>(10 + b));
  const Volume* volume = wait_for_volume(1);
  for (int b = 0; b < plan.b_scans; ++b)
    EXPECT_EQ(volume->b_scan(b).front(), 10 + b);
  stop();
  EXPECT_TRUE(has_fault(Fault::stuck_sequence));
}

TEST_F(VolumeThreadTest, triggers_nothing_without_a_camera_and_goes_on_when_it_is_back) {
  start();
  trigger.wait_for_pulse(0);
  camera.unplug();
  await([&] { return camera.state() != DeviceState::streaming; });
  const std::size_t pulses = trigger.pulses();
  // Whoever tries to open it sleeps between, and so time goes on.
  await([&] { return volumes->counters().lost_volumes >= 3; });
  EXPECT_EQ(trigger.pulses(), pulses);
  camera.replug();
  await([&] { return camera.state() == DeviceState::streaming; });
  while (trigger.pulses() == pulses)
    clock.sleep_until(clock.await_waiter());
  const hal::TimePoint pulsed = trigger.wait_for_pulse(pulses);
  deliver(pulsed, 0, plan.b_scans);
  const Volume* volume = wait_for_volume(pulses + 1);
  EXPECT_EQ(volume->missing_b_scans(), 0);
  stop();
  EXPECT_EQ(camera.opened(), 2);
  EXPECT_TRUE(has_fault(fault_of(Device::line_camera, hal::ErrorCode::disconnected)));
}

TEST_F(VolumeThreadTest, stops_cleanly_with_frames_on_the_way) {
  start();
  const hal::TimePoint pulsed = trigger.wait_for_pulse(0);
  deliver(pulsed, 0, 5);
  await_frames(5);
  stop();
  EXPECT_EQ(volumes->counters().planned, 1U);
  EXPECT_EQ(volumes->counters().unfinished, 1U);
}

ScanPlan lagging_plan() {
  ScanPlan plan = slow_plan();
  plan.bidirectional = true;
  plan.turn_around_lines = 2;
  plan.scan_lag_a_scans = 1.5;
  return plan;
}

class BidirectionalTest : public VolumeThreadTest {
protected:
  BidirectionalTest() : VolumeThreadTest(lagging_plan()) {}
};

TEST_F(BidirectionalTest, a_volume_says_with_which_offset_it_was_placed) {
  start();
  const hal::TimePoint pulsed = trigger.wait_for_pulse(0);
  for (int b = 0; b < plan.b_scans; ++b)
    camera.deliver(static_cast<std::uint64_t>(b), time_of(pulsed, b),
                   static_cast<std::uint8_t>(10 + b));
  const Volume* volume = wait_for_volume(1);
  for (int b = 0; b < plan.b_scans; ++b)
    EXPECT_EQ(volume->b_scan(b).front(), 10 + b);
  EXPECT_EQ(volume->metadata.scan_lag_a_scans, 1.5);
  stop();
  EXPECT_EQ(volumes->scan_lag().in_use_a_scans, 1.5) << "nothing to be seen in these";
  EXPECT_TRUE(volumes->scan_lag().automatic);
  EXPECT_EQ(volumes->scan_lag().used, 0U);
}

} // namespace
} // namespace octascope::pipeline
