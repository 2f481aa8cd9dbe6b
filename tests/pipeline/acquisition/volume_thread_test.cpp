// The fixed-rate thread with its devices' threads: that it does what the scheduler decides
// (volume_scheduler_test.cpp), in the time of its clock.
#include <algorithm>
#include <array>
#include <complex>
#include <functional>
#include <memory>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "pipeline/acquisition/volume_thread.h"
#include "pipeline/volume/flow_scale.h"
#include "sim/clock/virtual_clock.h"
#include "tests/support/devices/fake_devices.h"

namespace octascope::pipeline {
namespace {

using namespace std::chrono_literals;
using hal::DeviceState;
using hal::FrameIntegrity;

// Eight B-scans in 400 ms, which pass when the test says so.
ScanPlan slow_plan() {
  ScanPlan plan;
  plan.samples = 32;
  plan.a_scans = 4;
  plan.fly_back_lines = 1;
  plan.b_scans = 8;
  plan.line_rate_hz = 100;
  return plan;
}

constexpr std::uint8_t saturated_fill = 200;

class VolumeThreadTest : public testing::Test {
protected:
  // `bins`: of a sweep, where volumes shall have flow.
  explicit VolumeThreadTest(const ScanPlan& scan_plan = slow_plan(),
                            const ReconstructBins& bins = {})
      : plan(scan_plan) {
    hal::LineCameraConfig config;
    config.format.samples_per_line = plan.samples;
    config.format.lines_per_frame = plan.lines_per_frame();
    config.buffers = 24;
    acquisition = std::make_unique<Acquisition>(camera, config, clock, faults, arrived);
    VolumeThreadSetup setup{
        .plan = plan,
        .trigger = {},
        .workers = 2,
        // A level is the frame's fill, so the test sees which frame went where.
        .reconstruct =
            [](std::size_t, const hal::LineFrame& frame, std::span<std::uint8_t> levels) {
              std::ranges::fill(levels, std::to_integer<std::uint8_t>(frame.bytes.front()));
              return frame.bytes.front() == std::byte{saturated_fill} ? 3 : 0;
            },
        .average = *NeighbourAverage::create({0, 1, 0}),
        .most_volumes = std::nullopt,
    };
    if (bins)
      setup.comparison = *RepeatComparison::create(plan, setup.workers, bins);
    volumes = std::make_unique<VolumeThread>(std::move(setup), trigger, *acquisition, camera, clock,
                                             faults, arrived, news);
  }

  void start() {
    ASSERT_TRUE(acquisition->start({}));
    await([&] { return camera.state() == DeviceState::streaming; });
    volumes->start({});
  }
  void stop() {
    volumes->stop();
    acquisition->stop();
    EXPECT_EQ(camera.on_loan(), 0U);
    const VolumeCounters c = volumes->counters();
    EXPECT_EQ(c.planned, c.acquired + c.lost_volumes + c.unfinished);
    EXPECT_EQ(c.acquired, c.published);
  }

  // The other threads come to it in their time, which is no time of the test's clock.
  static void await(const std::function<bool()>& so) {
    while (!so())
      std::this_thread::sleep_for(100us);
  }
  void await_frames(std::uint64_t frames) {
    await([&] { return acquisition->counters().frames >= frames; });
  }

  hal::TimePoint time_of(hal::TimePoint pulsed, int sweep) const {
    return pulsed + sweep * plan.frame_period();
  }
  // Until when a volume takes frames; how long after that it waits for a camera not looked at.
  hal::TimePoint accepts_until(hal::TimePoint pulsed) const {
    return pulsed + plan.sweep_duration() + plan.sweep_duration() / 6;
  }
  hal::Duration patience() const { return plan.sweep_duration() / 2; }

  // The B-scans from `begin` to before `end`, in order and each in its time.
  void deliver(hal::TimePoint pulsed, int begin, int end) {
    for (int b = begin; b < end; ++b)
      camera.deliver(static_cast<std::uint64_t>(b), time_of(pulsed, b), 10);
  }

  // So many frames came, and then nobody looks at the camera any more.
  void hold_camera_after(std::uint64_t frames) {
    await_frames(frames);
    camera.hold();
    camera.wait_until_held();
  }

  // Waits until a volume with this number has been published.
  const Volume* wait_for_volume(std::uint64_t number) {
    while (true) {
      if (const Volume* volume = volumes->take_newest(); volume && volume->metadata.index >= number)
        return volume;
      news.wait();
    }
  }

  bool has_fault(Fault kind) const {
    return std::ranges::any_of(faults.records(),
                               [&](const FaultRecord& f) { return f.kind == kind; });
  }

  ScanPlan plan;
  sim::VirtualClock clock;
  tests::FakeCamera camera;
  tests::FakeTrigger trigger{clock};
  FaultLog faults;
  Wakeup arrived, news;
  std::unique_ptr<Acquisition> acquisition;
  std::unique_ptr<VolumeThread> volumes;
};

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
  await([&] { return progress_of(3) == BScanProgress::finished; });
  EXPECT_EQ(progress_of(1), BScanProgress::finished) << "its neighbour is overdue";
  EXPECT_EQ(progress_of(2), BScanProgress::overdue);
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

ScanPlan three_repeats() {
  ScanPlan plan = slow_plan();
  plan.repeats = 3;
  plan.b_scans = 4;
  return plan;
}

class RepeatsTest : public VolumeThreadTest {
protected:
  RepeatsTest() : VolumeThreadTest(three_repeats()) {}

  void deliver(hal::TimePoint pulsed, std::initializer_list<int> sweeps) {
    for (const int sweep : sweeps)
      camera.deliver(static_cast<std::uint64_t>(sweep), time_of(pulsed, sweep),
                     static_cast<std::uint8_t>(10 * (sweep / 3 + 1) + 3 * (sweep % 3)));
  }
};

TEST_F(RepeatsTest, a_b_scan_is_the_average_of_its_sweeps) {
  start();
  deliver(trigger.wait_for_pulse(0), {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
  const Volume* volume = wait_for_volume(1);
  EXPECT_EQ(volume->missing_b_scans(), 0);
  for (int b = 0; b < 4; ++b) {
    for (const std::uint8_t level : volume->b_scan(b))
      ASSERT_EQ(level, 10 * (b + 1) + 3);
  }
  EXPECT_EQ(volume->metadata.lost_b_scans, 0);
  EXPECT_EQ(volume->metadata.lost_lines, 0);
  stop();
}

TEST_F(RepeatsTest, what_is_left_of_a_b_scan_is_shown_and_lost_sweeps_are_counted_in_lines) {
  start();
  // B-scan 0 lacks its middle, 1 has one only, 2 has none, 3 lacks its last.
  const hal::TimePoint pulsed = trigger.wait_for_pulse(0);
  deliver(pulsed, {0, 2, 4, 9, 10});
  await_frames(5);
  clock.sleep_until(accepts_until(pulsed));
  const Volume* volume = wait_for_volume(1);
  EXPECT_EQ(volume->b_scan(0).front(), 13);
  EXPECT_EQ(volume->b_scan(1).front(), 23);
  EXPECT_EQ(volume->b_scan_states[2], BScanState::missing);
  EXPECT_EQ(volume->b_scan(2).front(), 0);
  EXPECT_EQ(volume->b_scan(3).front(), 42);
  EXPECT_EQ(volume->metadata.lost_b_scans, 1);
  EXPECT_EQ(volume->metadata.lost_lines, 7 * plan.a_scans);
  stop();
}

TEST_F(RepeatsTest, a_sweep_that_comes_when_its_b_scan_was_made_is_refused) {
  start();
  const hal::TimePoint pulsed = trigger.wait_for_pulse(0);
  deliver(pulsed, {0, 1, 6}); // the sixth begins the B-scan after the next
  deliver(pulsed, {2, 1, 3, 4, 5, 7, 8, 9, 10, 11});
  await_frames(13);
  clock.sleep_until(accepts_until(pulsed));
  const Volume* volume = wait_for_volume(1);
  EXPECT_EQ(volume->b_scan(0).front(), 12) << "of 10 and 13";
  EXPECT_TRUE(has_fault(Fault::late_frame));
  EXPECT_TRUE(has_fault(Fault::doubled_frame));
  EXPECT_EQ(volume->metadata.lost_b_scans, 0);
  EXPECT_EQ(volume->metadata.lost_lines, plan.a_scans);
  stop();
}

TEST_F(RepeatsTest, stops_cleanly_with_b_scans_that_wait) {
  start();
  deliver(trigger.wait_for_pulse(0), {0, 1, 4, 10});
  await_frames(4);
  stop();
}

ScanPlan speckled_plan() {
  ScanPlan plan = three_repeats();
  plan.samples = 128;
  plan.a_scans = 32;
  return plan;
}

// A frame's fill is its level and the seed of its speckle, below air that is faint and always another.
int speckle_of(std::size_t, const hal::LineFrame& frame, const SweepBins& out) {
  const auto fill = std::to_integer<std::uint8_t>(frame.bytes.front());
  std::ranges::fill(out.levels, fill);
  std::minstd_rand random{fill};
  std::normal_distribution<float> normal;
  std::minstd_rand air{static_cast<unsigned>(frame.sequence) + 1};
  for (std::size_t i = 0; i < out.bins.size(); ++i) {
    const std::complex speckle{normal(random), normal(random)};
    const std::complex noise{normal(air), normal(air)};
    out.bins[i] = 0.03F * noise + (i % 64 < 32 ? 0.0F : 1.0F) * speckle;
  }
  return 0;
}

class FlowTest : public VolumeThreadTest {
protected:
  FlowTest() : VolumeThreadTest(speckled_plan(), speckle_of) {}

  void deliver(hal::TimePoint pulsed, int sweep, std::uint8_t fill) {
    camera.deliver(static_cast<std::uint64_t>(sweep), time_of(pulsed, sweep), fill);
  }
  const FlowStatistics& flow() const { return volumes->statistics().flow; }
};

TEST_F(FlowTest, a_volume_says_of_each_b_scan_whether_flow_could_be_told) {
  start();
  const hal::TimePoint pulsed = trigger.wait_for_pulse(0);
  for (const int sweep : {0, 1, 2})
    deliver(pulsed, sweep, 10);
  for (const int sweep : {3, 4, 5}) // the tissue is elsewhere each time
    deliver(pulsed, sweep, static_cast<std::uint8_t>(20 + sweep));
  for (const int sweep : {9, 11}) // nothing of B-scan 2, not all of 3
    deliver(pulsed, sweep, 30);
  await_frames(8);
  await([&] { return flow().tell.summary().count == 2; });
  clock.sleep_until(accepts_until(pulsed));
  const Volume* volume = wait_for_volume(1);
  ASSERT_TRUE(volume->has_flow());
  EXPECT_EQ(volume->flow_states,
            (std::vector{FlowState::told, FlowState::left_out, FlowState::none, FlowState::none}));
  for (int a = 0; a < plan.a_scans; ++a)
    for (const std::uint8_t count :
         volume->b_scan_flow(0).subspan(static_cast<std::size_t>(a) * 64 + 36, 28)) {
      ASSERT_GE(count, flow_static) << a;
      ASSERT_LT(count, 20) << a;
    }
  for (const int b : {1, 2, 3})
    for (const std::uint8_t count : volume->b_scan_flow(b))
      ASSERT_EQ(count, flow_untold) << b;
  const std::array levels{10, 24, 0, 30};
  for (int b = 0; b < plan.b_scans; ++b)
    EXPECT_EQ(volume->b_scan(b).front(), levels[static_cast<std::size_t>(b)]) << "as without flow";
  EXPECT_EQ(volume->b_scan_states[2], BScanState::missing);
  EXPECT_EQ(flow().volumes, 0U) << "not all of it";
  EXPECT_EQ(flow().told, 1U);
  EXPECT_EQ(flow().left_out, 1U);
  EXPECT_EQ(flow().none, 2U);
  EXPECT_EQ(flow().tell.summary().count, 3U);
  stop();
}

// Lines go before flow.
TEST_F(FlowTest, workers_that_are_behind_go_without_flow) {
  start();
  const hal::TimePoint pulsed = trigger.wait_for_pulse(0);
  for (const int sweep : {0, 1, 2})
    deliver(pulsed, sweep, 10);
  await([&] { return flow().tell.summary().count == 1; });
  clock.sleep_until(time_of(pulsed, 5) + plan.sweep_duration() / 7);
  for (const int sweep : {3, 4, 5})
    deliver(pulsed, sweep, 20);
  await([&] { return flow().no_time == 1; });
  for (int sweep = 6; sweep < plan.sweeps(); ++sweep)
    deliver(pulsed, sweep, 30);
  const Volume* volume = wait_for_volume(1);
  EXPECT_EQ(volume->flow_states,
            (std::vector{FlowState::told, FlowState::none, FlowState::told, FlowState::told}));
  EXPECT_EQ(volume->b_scan_flow(1)[50], flow_untold);
  EXPECT_EQ(volume->b_scan(1).front(), 20);
  EXPECT_EQ(volume->missing_b_scans(), 0);
  stop();
}

// Buffers are used again: a B-scan that does not come has nothing left of the volume before.
TEST_F(FlowTest, nothing_is_left_of_an_earlier_volume) {
  constexpr int volume_count = 7; // more than there are buffers
  start();
  std::uint64_t frames = 0;
  for (int number = 0; number < volume_count; ++number) {
    const bool last = number + 1 == volume_count;
    const hal::TimePoint pulsed = trigger.wait_for_pulse(static_cast<std::size_t>(number));
    for (int sweep = last ? plan.repeats : 0; sweep < plan.sweeps(); ++sweep, ++frames)
      deliver(pulsed, sweep, 10);
    await([&] { return flow().tell.summary().count == frames / 3; });
    clock.sleep_until(accepts_until(pulsed));
    const Volume* volume = wait_for_volume(static_cast<std::uint64_t>(number) + 1);
    EXPECT_EQ(volume->flow_states[0], last ? FlowState::none : FlowState::told);
    EXPECT_EQ(volume->b_scan_flow(0)[50] == flow_untold, last);
    EXPECT_NE(volume->b_scan_flow(1)[50], flow_untold);
  }
  stop();
  EXPECT_EQ(flow().volumes, static_cast<std::uint64_t>(volume_count) - 1);
}

TEST_F(RepeatsTest, volumes_have_no_flow_where_nobody_asks) {
  start();
  deliver(trigger.wait_for_pulse(0), {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11});
  const Volume* volume = wait_for_volume(1);
  EXPECT_FALSE(volumes->has_flow());
  EXPECT_EQ(volume->flow.capacity(), 0U);
  EXPECT_EQ(volume->flow_states.capacity(), 0U);
  stop();
  EXPECT_EQ(volumes->statistics().flow.tell.summary().count, 0U);
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
