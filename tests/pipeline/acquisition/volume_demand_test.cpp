// Which volumes are built where the renderer takes longer for one than its scan lasts.
#include "pipeline/acquisition/volume_demand.h"
#include "tests/pipeline/acquisition/volume_thread_stage.h"

namespace octascope::pipeline {
namespace {

class VolumeDemandRule : public testing::Test {
protected:
  VolumeDemandRule() { demand.expect(Showing::whole); }

  static constexpr hal::TimePoint begin{10s};
  static constexpr hal::Duration period = 100ms;

  // The renderer draws so many volumes, each in that time, and ends with the last one at `begin`.
  void draw(hal::Duration each, int volumes) {
    for (int i = volumes; i > 0; --i) {
      demand.taken(begin - i * each);
      demand.drawn(begin - (i - 1) * each);
    }
  }

  bool wants(hal::TimePoint pulsed, std::optional<hal::TimePoint> waits_since = std::nullopt,
             bool another_is_built = false) const {
    return demand.would_be_seen(pulsed, period, waits_since, another_is_built);
  }

  VolumeDemand demand;
};

TEST_F(VolumeDemandRule, wants_every_volume_of_a_renderer_that_is_as_fast_as_the_scan) {
  EXPECT_TRUE(wants(begin, begin)) << "nothing is known of it";
  draw(140ms, 16);
  EXPECT_TRUE(wants(begin));
  EXPECT_TRUE(wants(begin, begin)) << "the next one waits for half of a scan at most";
}

TEST_F(VolumeDemandRule, does_not_want_what_would_be_replaced_before_it_is_taken) {
  draw(160ms, 16);
  EXPECT_TRUE(wants(begin));
  EXPECT_FALSE(wants(begin, begin));
  EXPECT_FALSE(wants(begin, std::nullopt, true));
  EXPECT_TRUE(wants(begin + 11ms, begin)) << "it may be at it for 11 ms already";
  demand.taken(begin);
  EXPECT_FALSE(wants(begin + 1ms));
  EXPECT_TRUE(wants(begin + 11ms)) << "it has 149 ms to go";
  EXPECT_FALSE(wants(begin + 11ms, begin + 10ms));
  EXPECT_FALSE(wants(begin + 11ms, std::nullopt, true));
}

TEST_F(VolumeDemandRule, gives_a_renderer_that_lacks_the_cores_half_as_long_again) {
  EXPECT_TRUE(wants(begin + 300ms, begin)) << "it has not taken it yet";
  EXPECT_FALSE(wants(begin + 301ms, begin));
  demand.taken(begin);
  EXPECT_TRUE(wants(begin + 300ms));
  EXPECT_FALSE(wants(begin + 301ms));
  demand.drawn(begin + 400ms);
  EXPECT_TRUE(wants(begin + 400ms, begin + 400ms)) << "one of sixteen";
}

TEST_F(VolumeDemandRule, counts_what_else_was_drawn_before_a_volume_was_taken) {
  draw(20ms, 5);
  for (int i = 0; i < 16; ++i) { // published while another frame was drawn
    demand.taken(begin + i * 400ms);
    demand.drawn(begin + i * 400ms + 160ms);
  }
  EXPECT_FALSE(wants(begin + 6400ms, begin + 6400ms));
}

TEST_F(VolumeDemandRule, does_not_want_what_comes_while_one_is_about_to_replace_another) {
  EXPECT_TRUE(wants(begin, std::nullopt, true));
  EXPECT_FALSE(wants(begin, begin, true));
}

TEST_F(VolumeDemandRule, wants_what_rolls_of_a_renderer_that_comes_to_it_before_it_is_whole) {
  demand.expect(Showing::rolling);
  draw(60ms, 16);
  EXPECT_TRUE(wants(begin + 90ms, begin, true)) << "it may have just begun";
  EXPECT_FALSE(wants(begin + 201ms, begin, true)) << "it does not come to it";
  demand.begun(begin);
  EXPECT_TRUE(wants(begin + 1ms, std::nullopt, true)) << "it goes on while it is built";
  EXPECT_FALSE(wants(begin + 1ms, begin, true)) << "the one before comes first";
  EXPECT_TRUE(wants(begin + 200ms, std::nullopt, true));
  EXPECT_FALSE(wants(begin + 201ms, std::nullopt, true)) << "it lacks the cores";
  demand.begun(begin + 190ms);
  EXPECT_FALSE(wants(begin + 201ms, std::nullopt, true)) << "it is the same frame";
  demand.drawn(begin + 210ms);
  EXPECT_TRUE(wants(begin + 210ms, std::nullopt, true));
}

class VolumeDemandTest : public VolumeThreadTest {
protected:
  // Takes the first volume as soon as it is there, and is not done with it.
  void begin_drawing() {
    start();
    volumes->expect(Showing::whole);
    deliver_frames(plan.b_scans);
    wait_for_volume(1);
    await_next_pulse();
  }

  // Of the next volume. A whole one is done with before any time passes.
  void deliver_frames(int frames) {
    pulsed = trigger.wait_for_pulse(scanned++);
    const std::uint64_t before = finished();
    for (int b = 0; b < frames; ++b)
      camera.deliver(delivered++, time_of(pulsed, b), 10);
    await_frames(delivered);
    await([&] { return acquisition->on_loan() == 0; });
    if (frames == plan.b_scans)
      await([&] { return finished() > before; });
  }
  void await_next_pulse() {
    clock.sleep_until(pulsed + plan.tick_period());
    trigger.wait_for_pulse(scanned);
  }
  void scan(int frames) {
    deliver_frames(frames);
    await_next_pulse();
  }
  void scan_whole(int times) {
    for (int i = 0; i < times; ++i)
      scan(plan.b_scans);
  }
  VolumeCounters counters() const { return volumes->counters(); }
  std::uint64_t finished() const { return counters().published + counters().passed_over; }

  hal::TimePoint pulsed; // the volume before the next one
  std::uint64_t delivered = 0;
  std::size_t scanned = 0;
};

TEST_F(VolumeDemandTest, passes_over_what_a_busy_renderer_would_not_see) {
  begin_drawing();
  scan_whole(3); // it has been at it for 1.2 s then
  await([&] { return counters().published == 4; });
  EXPECT_EQ(counters().passed_over, 0U);
  scan_whole(3);
  await([&] { return counters().passed_over == 3; });
  EXPECT_EQ(counters().published, 4U);
  deliver_frames(plan.b_scans);
  volumes->note_drawn();
  await_next_pulse();
  scan_whole(1);
  await([&] { return counters().published == 5; });
  stop();
  EXPECT_EQ(counters().passed_over, 4U);
  EXPECT_EQ(counters().lost_lines, 0U);
  EXPECT_TRUE(faults.records().empty());
}

TEST_F(VolumeDemandTest, passes_over_what_comes_while_one_is_about_to_replace_another) {
  begin_drawing();
  scan_whole(1);          // waits for the renderer
  scan(plan.b_scans - 2); // replaces it as soon as its time is over
  scan_whole(1);
  await([&] { return counters().published == 3; });
  stop();
  EXPECT_EQ(counters().passed_over, 1U);
  EXPECT_EQ(counters().skipped, 1U);
  EXPECT_EQ(counters().lost_b_scans, 2U);
}

TEST_F(VolumeDemandTest, counts_what_is_lost_of_a_volume_that_is_passed_over) {
  begin_drawing();
  scan_whole(3);
  scan(plan.b_scans - 2);
  scan(0);
  scan_whole(1);
  await([&] { return counters().passed_over == 2; });
  stop();
  EXPECT_EQ(counters().lost_volumes, 1U);
  EXPECT_EQ(counters().lost_b_scans, 2U + 8U);
  EXPECT_EQ(counters().lost_lines, (2U + 8U) * 4U);
}

TEST_F(VolumeDemandTest, builds_every_volume_that_somebody_else_wants) {
  wants_every_volume = true;
  begin_drawing();
  scan_whole(6);
  await([&] { return counters().published == 7; });
  stop();
  EXPECT_EQ(counters().passed_over, 0U);
}

TEST_F(VolumeDemandTest, builds_every_volume_of_a_renderer_that_shows_nothing) {
  begin_drawing();
  volumes->expect(Showing::nothing);
  scan_whole(6);
  await([&] { return counters().published == 7; });
  stop();
  EXPECT_EQ(counters().passed_over, 0U);
}

TEST_F(VolumeDemandTest, passes_over_what_would_be_whole_before_a_b_scan_of_it_is_seen) {
  begin_drawing();
  volumes->expect(Showing::rolling);
  scan_whole(2); // it has been at one frame for 0.8 s then: of the second one nothing would be seen
  await([&] { return counters().published == 3; });
  scan_whole(2);
  await([&] { return counters().passed_over == 2; });
  deliver_frames(plan.b_scans);
  EXPECT_NE(volumes->take_newest(), nullptr);
  volumes->note_drawn();
  await_next_pulse();
  for (int i = 0; i < 3; ++i) {
    deliver_frames(plan.b_scans);
    volumes->take_newest();
    volumes->note_begun();
    volumes->note_drawn();
    await_next_pulse();
  }
  stop();
  EXPECT_EQ(counters().published, 6U);
  EXPECT_EQ(counters().passed_over, 3U);
}

} // namespace
} // namespace octascope::pipeline
