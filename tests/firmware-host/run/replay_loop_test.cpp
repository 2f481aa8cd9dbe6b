// The render loop on volumes that were recorded: nobody has to tell it that they are not live.
#include <algorithm>

#include "firmware-host/outputs/local_time.h"
#include "firmware-host/report/replay_text.h"
#include "pipeline/recordings/replay/replay_player.h"
#include "tests/firmware-host/run/loop_stage.h"
#include "tests/ui/support/synthetic_volume.h"

namespace octascope::tests {
namespace {

using namespace std::chrono_literals;
using ui::Liveness;

constexpr std::int64_t noon_ns = 1'795'345'803'000'000'000;

// Two volumes 141 ms apart, again and again.
pipeline::ReplaySource two_volumes() {
  pipeline::ReplaySource source;
  source.facts.geometry = small_geometry;
  source.facts.volume_period_s = 0.141;
  for (const std::int64_t n : {0, 1})
    source.volumes.push_back({.index = static_cast<std::uint64_t>(n + 1),
                              .first_line_ns = n * 141'000'000,
                              .last_line_ns = n * 141'000'000 + 130'000'000,
                              .published_ns = n * 141'000'000 + 135'000'000,
                              .wall_clock_ns = noon_ns + n * 1'000'000'000});
  const pipeline::Volume tissue = tissue_volume(small_geometry);
  source.read = [tissue](std::size_t, pipeline::Volume& volume) -> hal::Result<> {
    std::ranges::copy(tissue.levels, volume.levels.begin());
    std::ranges::fill(volume.b_scan_states, pipeline::BScanState::good);
    return {};
  };
  return source;
}

class ReplayLoop : public LoopStage {
protected:
  // As start() does, with the recording in the camera's place.
  void start_replay(const pipeline::PatientEye& whose = {}) {
    firmware_host::RenderLoopSetup replay = setup();
    replay.host.whose = whose;
    replay.host.replayed = !whose.subject.empty();
    replay.controls.switch_actions.push_back(
        {.switches = 2, .gesture = ui::GestureKind::press, .action = ui::Action::record});
    open(std::move(replay), player_, nullptr, nullptr);
  }
  void turn_with_replay() {
    player_.step(clock_.now());
    turn();
  }
  void play(hal::Duration time) {
    const hal::TimePoint end = clock_.now() + time;
    while (clock_.now() < end)
      turn_with_replay();
  }
  std::string recorded() const { return loop_->status().replay.value().recorded; }

  pipeline::ReplayPlayer player_{two_volumes(), {}, faults_, news_};
};

TEST_F(ReplayLoop, is_never_live_and_says_when_each_volume_was_recorded) {
  start_replay();
  play(100ms);
  ASSERT_TRUE(loop_->status().replay) << "although the host has said nothing";
  EXPECT_EQ(recorded(), firmware_host::local_date_and_time(noon_ns));
  bool later = false;
  for (int i = 0; i < 60; ++i) {
    turn_with_replay();
    ASSERT_EQ(loop_->status().freshness.liveness, Liveness::replayed);
    later = later || recorded() == firmware_host::local_date_and_time(noon_ns + 1'000'000'000);
  }
  EXPECT_TRUE(later) << "the next volume has a time of its own";
  EXPECT_LT(loop_->statistics().latency.summary().p50_ms, 200) << "since its last line, as if live";
}

TEST_F(ReplayLoop, that_stops_is_neither_live_nor_stale) {
  start_replay();
  play(200ms);
  const std::string shown = recorded();
  turn_until(clock_.now() + 10s); // nothing comes any more
  EXPECT_EQ(loop_->status().freshness.liveness, Liveness::replayed);
  EXPECT_EQ(recorded(), shown);
}

TEST_F(ReplayLoop, that_is_frozen_is_still_a_replay) {
  start_replay();
  play(200ms);
  const std::string shown = recorded();
  press_freeze();
  play(1s);
  EXPECT_EQ(loop_->status().freshness.liveness, Liveness::frozen);
  EXPECT_EQ(recorded(), shown) << "of the volume that is shown";
}

TEST_F(ReplayLoop, cannot_be_recorded_and_says_so) {
  start_replay();
  play(100ms);
  send_controls({{clock_.now(), hal::ControlKind::pedal_switch, 1, 1},
                 {clock_.now(), hal::ControlKind::pedal_switch, 1, 0}});
  play(50ms);
  EXPECT_EQ(view().echo.words.view(), "not while a recording is replayed");
}

TEST_F(ReplayLoop, says_whose_it_is_from_the_first_frame_on) {
  start_replay({"Überlänge mit Umläuten und\nmehr", pipeline::Eye::right});
  turn();
  EXPECT_TRUE(loop_->status().replay);
  EXPECT_EQ(loop_->status().eye, pipeline::Eye::right);
  EXPECT_EQ(loop_->status().subject, "Überlänge mit Umläute…");
}

TEST(ReplayWords, tell_a_time_that_nobody_said) {
  EXPECT_EQ(firmware_host::local_date_and_time(0), "time not said");
  EXPECT_EQ(firmware_host::local_date_and_time(std::numeric_limits<std::int64_t>::min()),
            "time not said");
  EXPECT_EQ(firmware_host::local_date_and_time(noon_ns).substr(0, 8), "2026-11-");
  EXPECT_EQ(firmware_host::pause_words(63s), "A pause of 1:03 is left out");
  EXPECT_EQ(firmware_host::pause_words(24h), "A pause of 24 h 00 min is left out");
}

} // namespace
} // namespace octascope::tests
