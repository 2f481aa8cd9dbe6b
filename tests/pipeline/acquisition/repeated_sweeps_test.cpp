// Volumes of B-scans that are swept several times: their average, and what flows in them.
#include <algorithm>
#include <array>
#include <complex>
#include <initializer_list>
#include <random>
#include <vector>

#include "pipeline/volume/flow_scale.h"
#include "tests/pipeline/acquisition/volume_thread_stage.h"

namespace octascope::pipeline {
namespace {

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
    out.bins[i] = PackedBin::of(0.03F * noise + (i % 64 < 32 ? 0.0F : 1.0F) * speckle);
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
  // As who draws it relies on.
  static void expect_marks_of_its_flow(const Volume& volume) {
    FlowMarks made_anew{volume.geometry, blank_depth_bins};
    for (int b = 0; b < volume.geometry.b_scans; ++b) {
      made_anew.update(b, volume.b_scan_flow(b));
      EXPECT_TRUE(std::ranges::equal(volume.flow_marks.of(b), made_anew.of(b))) << b;
    }
  }
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
  expect_marks_of_its_flow(*volume);
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
  expect_marks_of_its_flow(*volume);
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
    expect_marks_of_its_flow(*volume);
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

} // namespace
} // namespace octascope::pipeline
