// What the display says, in words.
#include <gmock/gmock.h>

#include "tests/ui/support/renderer_stage.h"
#include "ui/hud/hud.h"

namespace octascope::tests {
namespace {

using namespace ui;

std::vector<std::string> badges_of(const Status& status) {
  const HudText hud = compose_hud_text({}, status, {});
  std::vector<std::string> words;
  for (std::size_t i = 0; i < hud.badge_count; ++i)
    words.emplace_back(hud.badges[i].text.view());
  return words;
}

std::vector<std::string> troubles_of(const Status& status) {
  const HudText hud = compose_hud_text({}, status, {});
  std::vector<std::string> words;
  for (std::size_t i = 0; i < hud.trouble_count; ++i)
    words.emplace_back(hud.troubles[i].words.view());
  return words;
}

ViewState with_figures() {
  ViewState view;
  view.figures = FiguresShown::strip;
  return view;
}

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
  shown.b_scan = pipeline::BScanState::saturated;
  EXPECT_EQ(compose_hud_text(view, status, shown).b_scan.note.view(), "B-scan 41 of 80: saturated");
}

TEST(HudText, branches_are_named_in_the_hearts_arteries_only) {
  Status status = live_status();
  status.vessels.state = VesselStatus::State::shown;
  const auto named = [&](std::array<bool, pipeline::vessel_branch_count> branches) {
    status.vessels.branches = branches;
    return compose_hud_text({}, status, {}).vessels.branches;
  };
  constexpr std::array<bool, pipeline::vessel_branch_count> none{};
  for (const auto& generic : {std::array{true, false, false, false},
                              {false, false, false, true},
                              {true, false, false, true},
                              {false, true, true, false}})
    EXPECT_EQ(named(generic), none);
  EXPECT_EQ(named({false, true, true, true}), (std::array{false, true, true, true}));
  EXPECT_EQ(named({true, true, true, true}), (std::array{true, true, true, true}));
}

TEST(HudText, vessels_say_how_well_they_were_registered) {
  Status status = live_status();
  status.vessels.state = VesselStatus::State::shown;
  const auto told = [&](const ViewState& view = {}) {
    return std::string{compose_hud_text(view, status, {}).vessels.registration.view()};
  };
  status.vessels.residual_mm = 0.0123;
  EXPECT_EQ(told(), "") << "not registered";
  status.vessels.registered = true;
  EXPECT_EQ(told(), "residual 12 µm");
  status.vessels.residual_mm = 2160.2284;
  EXPECT_EQ(told(), "residual 2160 mm");
  ViewState moved;
  moved.vessel_nudge.turn_deg[1] = 0.5F;
  EXPECT_EQ(told(moved), "adjusted by hand");
  status.vessels.residual_mm.reset();
  EXPECT_EQ(told(), "residual unknown");
}

TEST(HudText, a_tree_that_is_followed_says_its_overlap_or_that_it_does_not_match) {
  using State = FollowedTreeStatus::State;
  Status status = live_status();
  const auto told = [&](const ViewState& view = {}) {
    return compose_hud_text(view, status, {}).vessels;
  };
  status.vessels.state = VesselStatus::State::shown;
  status.vessels.registered = true;
  status.vessels.residual_mm = 0.0143;
  status.vessels.followed = FollowedTreeStatus{State::followed, 0.917, {}};
  EXPECT_EQ(told().registration.view(), "residual 14 µm, overlap 91 %");
  EXPECT_EQ(told().tree.view(), "");
  // Where somebody said that it lies, it stays, and is marked.
  status.vessels.followed = FollowedTreeStatus{State::unmatched, 0, {}};
  EXPECT_TRUE(told().shown);
  EXPECT_EQ(told().tree.view(), "vessels do not match");
  EXPECT_TRUE(told().tree_old);
  // Nowhere else: it is not drawn.
  status.vessels.state = VesselStatus::State::none;
  EXPECT_FALSE(told().shown);
  EXPECT_EQ(told().tree.view(), "vessels do not match");
  const HudText hud = compose_hud_text({}, status, {});
  ASSERT_GT(hud.trouble_count, 0U);
  EXPECT_EQ(hud.troubles[hud.trouble_count - 1].words.view(), "vessels do not match");
  status.vessels.followed = FollowedTreeStatus{};
  EXPECT_EQ(told().tree.view(), "vessels not placed yet");
  EXPECT_FALSE(told().tree_old);
  ViewState hidden;
  hidden.vessels = VesselsShown::off;
  EXPECT_EQ(told(hidden).tree.view(), "") << "nobody wants to see them";
}

TEST(HudText, flow_that_cannot_be_drawn_is_said) {
  ShownPictures shown;
  shown.flow.refused = true;
  const HudText hud = compose_hud_text({}, live_status(), shown);
  ASSERT_GT(hud.trouble_count, 0U);
  EXPECT_EQ(hud.troubles[0].words.view(), "flow cannot be drawn");
}

TEST(HudText, a_tree_that_was_not_registered_for_long_is_marked_with_its_age) {
  using Followed = FollowedTreeStatus;
  Status status = live_status();
  const auto told = [&] { return compose_hud_text({}, status, {}).vessels; };
  status.vessels.state = VesselStatus::State::shown;
  status.vessels.registered = true;
  status.vessels.residual_mm = 0.0143;
  status.vessels.followed = Followed{Followed::State::followed, 0.917,
                                     Followed::old_after - std::chrono::milliseconds{1}};
  EXPECT_EQ(told().tree.view(), "");
  status.vessels.followed->age = Followed::old_after;
  EXPECT_EQ(told().tree.view(), "vessels placed 3 s ago");
  EXPECT_TRUE(told().tree_old);
  EXPECT_EQ(told().registration.view(), "residual 14 µm, overlap 91 %");
  status.vessels.followed = Followed{Followed::State::removed, 0, std::chrono::seconds{32}};
  EXPECT_EQ(told().tree.view(), "vessels as placed by hand");
  status.vessels.state = VesselStatus::State::none;
  EXPECT_EQ(told().tree.view(), "no vessels: placed 32 s ago");
  const HudText hud = compose_hud_text({}, status, {});
  ASSERT_GT(hud.trouble_count, 0U);
  EXPECT_EQ(hud.troubles[hud.trouble_count - 1].words.view(), "no vessels: placed 32 s ago");
}

TEST(HudText, a_tree_that_is_old_is_marked_and_one_that_is_not_drawn_has_its_reason) {
  using State = TracedTreeStatus::State;
  using Words = std::vector<std::string>;
  Status status = live_status();
  const auto told = [&](const ViewState& view = {}) {
    return compose_hud_text(view, status, {}).vessels;
  };
  EXPECT_EQ(told().tree.view(), "");
  status.vessels.state = VesselStatus::State::shown;
  status.vessels.registered = true;
  status.vessels.traced = TracedTreeStatus{.state = State::shown,
                                           .age = std::chrono::milliseconds{999},
                                           .vessels = 12,
                                           .length_mm = 8.34,
                                           .refusal = {}};
  EXPECT_EQ(told().tree.view(), "tree < 1 s old, 12 vessels, 8.3 mm");
  EXPECT_EQ(told().registration.view(), "") << "it was traced where it is";
  EXPECT_FALSE(told().tree_old);
  EXPECT_EQ(troubles_of(status), Words{});
  status.vessels.traced->age = TracedTreeStatus::old_after - std::chrono::milliseconds{1};
  EXPECT_EQ(told().tree.view(), "tree 2 s old, 12 vessels, 8.3 mm");
  EXPECT_FALSE(told().tree_old);
  status.vessels.traced->age = TracedTreeStatus::old_after;
  EXPECT_TRUE(told().tree_old);
  EXPECT_EQ(troubles_of(status), Words{"tree 3 s old"});
  ViewState hidden;
  hidden.vessels = VesselsShown::off;
  EXPECT_EQ(told(hidden).tree.view(), "");

  status.vessels.state = VesselStatus::State::none;
  status.vessels.traced->state = State::removed;
  status.vessels.traced->age = std::chrono::seconds{75};
  EXPECT_EQ(told().tree.view(), "no tree: the last is 75 s old");
  EXPECT_FALSE(told().shown);
  EXPECT_EQ(troubles_of(status), Words{"no vessel tree"});
  status.vessels.traced->state = State::refused;
  status.vessels.traced->refusal = "no vessel was found";
  EXPECT_EQ(told().tree.view(), "no tree: no vessel was found");
  EXPECT_EQ(troubles_of(status), Words{"no vessel tree"});
}

TEST(HudText, merged_vessels_and_their_account_are_told) {
  Status status = live_status();
  status.vessels.state = VesselStatus::State::shown;
  status.vessels.account = {1, 20, 300, 4000};
  ViewState view;
  EXPECT_FALSE(compose_hud_text(view, status, {}).vessels.account) << "on request";
  view.vessel_account = true;
  EXPECT_EQ(compose_hud_text(view, status, {}).vessels.account->total(), 4321U);
  EXPECT_EQ(compose_hud_text(view, status, {}).facts[2].view(), "thinnest vessels merged");
  status.reduced_quality = 0.5F;
  EXPECT_EQ(compose_hud_text(view, status, {}).facts[2].view(),
            "quality reduced to 50 %, thinnest vessels merged");
  status.vessels.account.merged = 0;
  EXPECT_EQ(compose_hud_text(view, status, {}).facts[2].view(), "quality reduced to 50 %");
}

TEST(HudText, vessels_that_a_flat_picture_leaves_out_are_told) {
  Status status = live_status();
  status.vessels.state = VesselStatus::State::shown;
  ShownPictures shown;
  shown.vessels_left_out = true;
  ViewState view;
  EXPECT_EQ(compose_hud_text(view, status, shown).facts[2].view(), "thinnest vessels left out");
  status.vessels.account.merged = 3;
  EXPECT_EQ(compose_hud_text(view, status, shown).facts[2].view(),
            "thinnest vessels merged or left out");
  view.vessels = VesselsShown::flow;
  EXPECT_EQ(compose_hud_text(view, status, shown).facts[2].view(), "");
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
