// What the display says, in words.
#include <gmock/gmock.h>

#include "tests/ui/support/hud_words.h"
#include "tests/ui/support/renderer_stage.h"
#include "ui/hud/hud.h"

namespace octascope::tests {
namespace {

using namespace ui;

TEST(HudText, another_cameras_calibration_is_told_as_long_as_it_is_used) {
  Status status = live_status();
  status.simulated = false;
  status.another_camera = true;
  EXPECT_EQ(badges_of(status), std::vector<std::string>{"another camera's calibration"});
}

TEST(HudText, badges_say_what_is_not_live) {
  using std::chrono::milliseconds;
  using std::chrono::seconds;
  using Words = std::vector<std::string>;
  Status status = live_status();
  status.simulated = false;
  EXPECT_EQ(badges_of(status), Words{});
  status.simulated = true;
  EXPECT_EQ(badges_of(status), Words{"SIMULATED"});
  status.freshness = {Liveness::stale, milliseconds{1290}, {}};
  EXPECT_EQ(badges_of(status), (Words{"STALE 1.2 s", "SIMULATED"}));
  status.freshness = {Liveness::stale, milliseconds{59'990}, {}};
  EXPECT_EQ(badges_of(status)[0], "STALE 59.9 s");
  status.freshness = {Liveness::veiled, seconds{75}, {}};
  EXPECT_EQ(badges_of(status)[0], "NO LIVE PICTURE 1:15");
  status.freshness = {Liveness::frozen, seconds{700}, seconds{12}};
  EXPECT_EQ(badges_of(status)[0], "FROZEN 0:12");
  status.missing_b_scans = 1;
  status.saturated_lines = 4;
  EXPECT_EQ(badges_of(status)[2], "1 B-scan missing");
  EXPECT_EQ(badges_of(status)[3], "4 lines saturated");
}

TEST(HudText, a_rolling_volume_says_how_old_either_side_of_its_seam_is) {
  using std::chrono::milliseconds;
  Status status = live_status();
  status.simulated = false;
  ShownPictures shown;
  shown.volume = true;
  const auto badge = [&] { return compose_hud_text({}, status, shown).badges[0].text; };
  status.rolling.emplace();
  EXPECT_EQ(badge().view(), "rolling");
  status.rolling->seam = {milliseconds{19}, milliseconds{199}};
  EXPECT_EQ(badge().view(), "rolling 0.0 s | 0.1 s");
  status.rolling->seam = {milliseconds{1210}, milliseconds{1350}};
  EXPECT_EQ(badge().view(), "rolling 1.2 s | 1.3 s");
  status.rolling->seam.reset();
  status.rolling->possible = false;
  EXPECT_EQ(badge().view(), "whole volumes: surface");
  status.replay.emplace();
  const HudText replayed = compose_hud_text({}, status, shown);
  EXPECT_EQ(replayed.badges[replayed.badge_count - 1].text.view(), "whole volumes: recording");
  status.replay.reset();
  status.freshness.liveness = Liveness::frozen;
  EXPECT_EQ(compose_hud_text({}, status, shown).badge_count, 1U) << "what is frozen is whole";
}

// "41 of 80 missing" by itself would read as a count.
TEST(HudText, a_b_scan_that_is_not_whole_is_named) {
  ShownPictures shown;
  shown.volume = true;
  shown.geometry.b_scans = 80;
  ViewState view;
  view.b_scan = 40;
  const auto caption = [&](pipeline::BScanState state) {
    shown.b_scan = state;
    return compose_hud_text(view, live_status(), shown).b_scan;
  };
  EXPECT_EQ(caption(pipeline::BScanState::good).title.view(), "B-scan");
  EXPECT_EQ(caption(pipeline::BScanState::good).note.view(), "41 of 80");
  EXPECT_EQ(caption(pipeline::BScanState::missing).title.view(), "") << "not twice";
  EXPECT_EQ(caption(pipeline::BScanState::missing).note.view(), "B-scan 41 of 80: missing");
  EXPECT_EQ(caption(pipeline::BScanState::saturated).note.view(), "B-scan 41 of 80: saturated");
}

// Whatever else is true of it: REPLAY comes first, and nothing in words or marks says live.
TEST(HudText, a_replay_says_so_with_date_and_time_in_every_state) {
  Status status = live_status();
  status.replay = ReplayStatus{};
  EXPECT_EQ(badges_of(status)[0], "REPLAY") << "before its first volume, too";
  status.replay->recorded = "2026-11-22 12:10:03";
  for (const Liveness liveness : {Liveness::waiting, Liveness::stale, Liveness::veiled,
                                  Liveness::frozen, Liveness::replayed}) {
    status.freshness.liveness = liveness;
    const auto words = badges_of(status);
    EXPECT_EQ(words[0], "REPLAY 2026-11-22 12:10:03");
    EXPECT_THAT(words, testing::Contains("SIMULATED"));
    const HudText hud = compose_hud_text({}, status, {});
    EXPECT_EQ(hud.eye.view(), "eye not said");
    EXPECT_EQ(hud.facts[0].view(), "subject not said");
    EXPECT_NE(hud.liveness, Liveness::live);
  }
  status.freshness.liveness = Liveness::replayed;
  status.simulated = false;
  status.eye = pipeline::Eye::right;
  status.subject = "4711";
  EXPECT_EQ(badges_of(status), std::vector<std::string>{"REPLAY 2026-11-22 12:10:03"});
  const HudText hud = compose_hud_text(with_figures(), status, {});
  EXPECT_EQ(hud.eye.view(), "right eye");
  EXPECT_EQ(hud.facts[0].view(), "subject 4711");
  EXPECT_EQ(hud.figures[1].label, "") << "no lines come";
}

TEST(HudText, a_recording_says_how_long_and_of_which_eye) {
  Status status = live_status();
  const auto text = [&] { return compose_hud_text({}, status, {}); };
  EXPECT_TRUE(text().recording.empty()) << "none is on";
  EXPECT_EQ(text().eye.view(), "eye not said");
  status.recording = {.on = true, .lasted = std::chrono::seconds{75}};
  EXPECT_EQ(text().recording.view(), "REC 1:15");
  EXPECT_EQ(text().eye.view(), "eye not said");
  status.eye = pipeline::Eye::left;
  EXPECT_EQ(text().eye.view(), "left eye");
  status.eye = pipeline::Eye::right;
  EXPECT_EQ(text().eye.view(), "right eye");
  EXPECT_EQ(text().trouble_count, 0U);
  status.recording.not_kept = 3;
  EXPECT_EQ(troubles_of(status), std::vector<std::string>{"3 not recorded"});
}

TEST(HudText, a_recording_says_how_much_room_is_left) {
  using namespace std::chrono_literals;
  Status status = live_status();
  const auto room = [&](hal::Duration left) {
    status.recording = {.on = true, .lasted = 1s, .not_kept = 0, .room = left};
    return std::string{compose_hud_text({}, status, {}).facts[1].view()};
  };
  EXPECT_EQ(room(599s), "room for 9:59");
  EXPECT_EQ(room(10min + 59s), "room for 10 min");
  EXPECT_EQ(room(100min), "room for 1 h");
  EXPECT_EQ(room(99h), "room for 99 h");
  EXPECT_EQ(room(1000h), "room for days");
  status.recording.on = false;
  EXPECT_TRUE(compose_hud_text({}, status, {}).facts[1].empty());
}

TEST(HudText, the_machines_figures_are_behind_an_action_and_have_their_units) {
  Status status = live_status();
  EXPECT_EQ(compose_hud_text({}, status, {}).figures[0].label, "") << "nobody asked for them";
  HudText hud = compose_hud_text(with_figures(), status, {});
  EXPECT_EQ(hud.figures[0].label, "Vol./s shown");
  EXPECT_EQ(hud.figures[0].value.view(), "6.6 of 7.1");
  EXPECT_EQ(hud.figures[1].value.view(), "215 k");
  EXPECT_EQ(hud.figures[2].value.view(), "60");
  EXPECT_EQ(hud.figures[3].value.view(), "32 / 44 ms");
  EXPECT_EQ(hud.figures[4].value.view(), "none");
  EXPECT_EQ(hud.figures[5].value.view(), "8 to 44 dB");
  status.shown_volumes_per_s = 7.3; // over the last seconds
  status.lines_per_s = 1'234'000;
  status.latency_p95_ms.reset();
  status.losses.b_scans = 2;
  hud = compose_hud_text(with_figures(), status, {});
  EXPECT_EQ(hud.figures[0].value.view(), "7.1 of 7.1") << "never more than came";
  EXPECT_EQ(hud.figures[1].value.view(), "1.23 M");
  EXPECT_EQ(hud.figures[3].value.view(), "–");
  EXPECT_EQ(hud.figures[4].value.view(), "0 / 2 / 0");
  EXPECT_EQ(hud.figures[4].tone, Tone::warning);
}

TEST(HudText, what_is_lost_or_gone_is_said_without_being_asked) {
  using Words = std::vector<std::string>;
  Status status = live_status();
  EXPECT_EQ(troubles_of(status), Words{});
  status.losses.lines = 1;
  EXPECT_EQ(troubles_of(status), Words{"1 line lost"});
  status.losses.b_scans = 2;
  EXPECT_EQ(troubles_of(status), Words{"2 B-scans lost"});
  status.losses.volumes = 3;
  EXPECT_EQ(troubles_of(status), Words{"3 volumes lost"});
  status.losses = {};
  status.devices[0].state = hal::DeviceState::absent;
  status.devices[2].state = hal::DeviceState::failed;
  EXPECT_EQ(troubles_of(status), (Words{"no camera", "pedal failed"}));
  status.replay.emplace();
  status.missing_b_scans = 2;
  EXPECT_EQ(troubles_of(status), (Words{"2 B-scans missing", "no camera", "pedal failed"}))
      << "a replay's badges may leave no room for theirs";
}

TEST(HudText, time_and_the_knob_are_said) {
  Status status = live_status();
  ViewState view;
  view.selected = Action::tilt;
  const HudText hud = compose_hud_text(view, status, {});
  EXPECT_EQ(hud.time_of_day.view(), "14:05");
  EXPECT_EQ(hud.selected, Action::tilt);
}

// Of this eye or none: the configuration alone says nothing, nor does an eye alone.
TEST(HudText, sides_are_those_of_the_eye_that_was_said) {
  using enum Side;
  Status status = live_status();
  const auto ends = [&] { return compose_hud_text({}, status, {}).ends; };
  status.orientation.labels.names = {"across", "", ""};
  EXPECT_EQ(compose_hud_text({}, status, {}).labels.names[0], "across");
  status.eye = pipeline::Eye::right;
  EXPECT_EQ(ends(), AxisEnds{});
  status.orientation.on_eye = {temporal, inferior};
  EXPECT_EQ(ends(), (AxisEnds{nasal, temporal, superior, inferior}));
  EXPECT_EQ(compose_hud_text({}, status, {}).labels.names[0], "") << "sides are better";
  status.eye = pipeline::Eye::left;
  EXPECT_EQ(ends(), (AxisEnds{temporal, nasal, superior, inferior})) << "mirrored";
  status.orientation.on_eye = {superior, nasal};
  EXPECT_EQ(ends(), (AxisEnds{inferior, superior, nasal, temporal}));
  status.eye = pipeline::Eye::not_said;
  EXPECT_EQ(ends(), AxisEnds{});
}

TEST(HudText, vessels_say_whether_they_are_where_they_seem_to_be) {
  Status status = live_status();
  status.simulated = false;
  status.vessels.state = VesselStatus::State::loading;
  status.vessels.progress = 0.437F;
  using Words = std::vector<std::string>;
  EXPECT_EQ(troubles_of(status), Words{"vessels 43 %"});
  EXPECT_EQ(badges_of(status), Words{});
  status.vessels.state = VesselStatus::State::failed;
  EXPECT_EQ(troubles_of(status), Words{"no vessels"});
  status.vessels.state = VesselStatus::State::shown;
  EXPECT_EQ(troubles_of(status), Words{"vessels not registered"});
  EXPECT_EQ(badges_of(status), std::vector<std::string>{"VESSELS NOT REGISTERED"});
  ViewState hidden;
  hidden.vessels = VesselsShown::off;
  EXPECT_EQ(compose_hud_text(hidden, status, {}).badge_count, 0U);
  status.vessels.registered = true;
  EXPECT_EQ(badges_of(status), std::vector<std::string>{});
}

TEST(HudText, flow_that_could_not_be_told_is_said) {
  const Status status = live_status();
  ShownPictures shown;
  shown.volume = true;
  shown.geometry = {512, 300, 80, 3.5, 10, 37.5};
  shown.b_scan = pipeline::BScanState::good;
  shown.scope = true;
  shown.scope_time = status.now;
  ViewState view;
  view.figures = FiguresShown::strip;
  EXPECT_EQ(compose_hud_text(view, status, shown).en_face.deepest.view(), "");
  EXPECT_FALSE(compose_hud_text(view, status, shown).vessels.flow);
  shown.flow = {.shown = true,
                .b_scan = pipeline::FlowState::told,
                .told = 60,
                .left_out = 20,
                .deepest_mm = 0.5,
                .in_scope = true};
  const HudText told = compose_hud_text(view, status, shown);
  EXPECT_EQ(told.en_face.deepest.view(), "0.5 mm");
  EXPECT_EQ(told.scope.deepest.view(), "0.5 mm");
  EXPECT_EQ(told.b_scan.note.view(), "41 of 80");
  EXPECT_EQ(told.figures.back().value.view(), "60 / 20");
  EXPECT_EQ(told.trouble_count, 0U);
  EXPECT_TRUE(told.vessels.flow);
  EXPECT_FALSE(told.vessels.shown);
  shown.flow.b_scan = pipeline::FlowState::left_out;
  EXPECT_EQ(compose_hud_text(view, status, shown).b_scan.note.view(), "41 of 80, moved: no flow");
  shown.flow.b_scan = pipeline::FlowState::none;
  EXPECT_EQ(compose_hud_text(view, status, shown).b_scan.note.view(), "41 of 80, no flow");
  shown.flow.left_out = 70;
  shown.flow.told = 10;
  EXPECT_EQ(compose_hud_text(view, status, shown).troubles[0].words.view(), "no flow: 87 % moved");
  shown.flow.none = 70; // workers that were behind
  shown.flow.left_out = 0;
  EXPECT_EQ(compose_hud_text(view, status, shown).troubles[0].words.view(), "no flow in 87 %");
  shown.flow.late = true;
  EXPECT_EQ(compose_hud_text(view, status, shown).troubles[0].words.view(),
            "no flow on surface: late");
  shown.b_scan = pipeline::BScanState::saturated;
  EXPECT_EQ(compose_hud_text(view, status, shown).b_scan.note.view(), "B-scan 41 of 80: saturated");
}

TEST(HudText, an_old_microscope_picture_is_stale) {
  const Status status = live_status();
  ShownPictures shown;
  shown.scope = true;
  shown.scope_time = status.now - std::chrono::milliseconds{900};
  EXPECT_FALSE(compose_hud_text({}, status, shown).scope_stale);
  shown.scope_time = status.now - std::chrono::milliseconds{3100};
  const HudText hud = compose_hud_text({}, status, shown);
  EXPECT_TRUE(hud.scope_stale);
  EXPECT_EQ(hud.scope.note.view(), "stale 3 s");
}

TEST(HudText, the_echo_lasts_for_a_moment) {
  Status status = live_status();
  ViewState view;
  view.echo = {Action::tilt, false, {}, status.now + std::chrono::milliseconds{1}};
  const HudText hud = compose_hud_text(view, status, {});
  EXPECT_TRUE(hud.echo.visible);
  EXPECT_EQ(hud.echo.name, "Tilt");
  EXPECT_EQ(hud.echo.value.view(), "35°");
  status.now = view.echo.until;
  EXPECT_FALSE(compose_hud_text(view, status, {}).echo.visible);
}

TEST(FixedText, long_text_is_cut_between_characters) {
  FixedText<5> text;
  text.format("abc–de"); // the dash is three bytes, from 3 to 5
  EXPECT_EQ(text.view(), "abc");
  text.format("ab–de");
  EXPECT_EQ(text.view(), "ab–");
  text.format("{}", 12345);
  EXPECT_EQ(text.view(), "12345");
}

} // namespace
} // namespace octascope::tests
