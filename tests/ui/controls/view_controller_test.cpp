#include <cmath>

#include "tests/ui/controls/controller_stage.h"

namespace octascope::ui {
namespace {

TEST_F(Controller, keys_steer_each_parameter_both_ways) {
  const auto moved = [&](auto up, auto down, auto member, float detent) {
    const auto before = static_cast<float>(state().*member);
    controller_.handle(up);
    EXPECT_FLOAT_EQ(static_cast<float>(state().*member), before + detent);
    controller_.handle(down);
    controller_.handle(down);
    EXPECT_FLOAT_EQ(static_cast<float>(state().*member), before - detent);
  };
  moved(press(Key::right), press(Key::left), &ViewState::yaw_deg, 3);
  moved(press(Key::up), press(Key::down), &ViewState::tilt_deg, 3);
  moved(press(Key::page_down), press(Key::page_up), &ViewState::distance, 0.05F);
  moved(press('-'), press('+'), &ViewState::distance, 0.05F);
  moved(press('o', true), press('o'), &ViewState::window_offset_db, 1);
  moved(press('s', true), press('s'), &ViewState::window_size_db, 1);
  moved(press(']'), press('['), &ViewState::b_scan, 1);
  moved(press('\''), press(';'), &ViewState::a_scan, 4);
  moved(press('x', true), press('x'), &ViewState::parallax_deg, 0.25F);
}

TEST_F(Controller, values_stop_at_their_ends_and_yaw_goes_round) {
  for (int i = 0; i < 500; ++i) {
    controller_.handle(press(']'));
    controller_.handle(press('\''));
    controller_.handle(press(Key::up));
    controller_.handle(press(Key::right));
  }
  EXPECT_EQ(state().b_scan, 79);
  EXPECT_EQ(state().a_scan, 299);
  EXPECT_FLOAT_EQ(state().tilt_deg, 89);
  EXPECT_LE(std::abs(state().yaw_deg), 180);
  actions().set_volume({.b_scans = 20});
  EXPECT_EQ(state().b_scan, 19);
}

TEST_F(Controller, space_and_the_centre_switch_freeze_with_their_time) {
  controller_.handle(press(Key::space));
  EXPECT_TRUE(state().frozen);
  EXPECT_EQ(state().frozen_since, now);
  EXPECT_EQ(state().echo.action, Action::freeze);
  EXPECT_EQ(echo(), "frozen");
  controller_.handle(press(static_cast<std::uint16_t>(Key::space), false, true));
  EXPECT_TRUE(state().frozen) << "a key held down does not flicker";
  tread({1});
  EXPECT_FALSE(state().frozen);
  EXPECT_EQ(echo(), "live");
  const hal::TimePoint let_go = now_ + milliseconds{150};
  tread({1});
  EXPECT_EQ(state().frozen_since, let_go);
}

TEST_F(Controller, pedal_chooses_what_the_knob_turns_and_the_display_echoes_it) {
  EXPECT_EQ(state().selected, Action::b_scan) << "moving the position comes first";
  turn(-2);
  EXPECT_EQ(state().b_scan, first_.b_scan - 2);
  tread({2});
  EXPECT_EQ(state().selected, Action::crossed_b_scan);
  EXPECT_EQ(state().echo.action, Action::crossed_b_scan);
  EXPECT_TRUE(state().echo.chosen);
  EXPECT_GT(state().echo.until, now_);
  turn(3);
  EXPECT_EQ(state().a_scan, first_.a_scan + 12);
  EXPECT_FALSE(state().echo.chosen);
  choose(Action::cut);
  turn(1);
  EXPECT_EQ(state().cut, CutShape::b_scan);
  EXPECT_EQ(echo(), "at the B-scan");
  turn(1);
  EXPECT_EQ(state().cut, CutShape::corner);
  EXPECT_EQ(echo(), "at both B-scans");
  tread({2});
  EXPECT_EQ(state().selected, Action::see_through);
  turn(-20);
  EXPECT_EQ(state().see_through_db, 0);
  tread({2});
  EXPECT_EQ(state().selected, Action::opacity);
  turn(2);
  EXPECT_FLOAT_EQ(state().opacity, first_.opacity + 0.1F);
  choose(Action::stereo);
  tread({2});
  EXPECT_EQ(state().selected, Action::vessels) << "past the unseen parallax and all of vessels";
  for (int i = 0; i < 6; ++i)
    tread({2});
  EXPECT_EQ(state().selected, Action::b_scan) << "round again";
  tread({0});
  EXPECT_EQ(state().selected, Action::figures);
  turn(1);
  EXPECT_EQ(state().figures, FiguresShown::strip);
  EXPECT_EQ(count(Action::adjust), 7U);
  EXPECT_EQ(count(Action::b_scan), 1U);
}

TEST_F(Controller, parallax_can_be_chosen_in_stereo) {
  controller_.handle(press('d'));
  EXPECT_EQ(state().stereo, StereoMode::side_by_side);
  choose(Action::parallax);
  turn(2);
  EXPECT_FLOAT_EQ(state().parallax_deg, first_.parallax_deg + 0.5F);
}

TEST_F(Controller, long_presses_do_what_is_chosen_keep_a_picture_and_find_the_window) {
  controller_.handle(press(Key::right));
  choose(Action::reset_view);
  EXPECT_EQ(tread({0}, milliseconds{700}), ControlRequests{});
  EXPECT_EQ(state().yaw_deg, first_.yaw_deg);
  EXPECT_EQ(count(Action::reset_view), 1U);
  choose(Action::record);
  EXPECT_TRUE(tread({0}, milliseconds{700}).record);
  actions().tell(Action::record, "begun", now_);
  EXPECT_EQ(echo(), "begun");
  EXPECT_TRUE(tread({1}, milliseconds{700}).snapshot);
  EXPECT_FALSE(state().frozen) << "a long press is no press";
  EXPECT_TRUE(tread({2}, milliseconds{700}).auto_window);
  actions().show_window(12, 30, now_);
  EXPECT_FLOAT_EQ(state().window_offset_db, 12);
  EXPECT_EQ(echo(), "12 to 42 dB");
  controller_.handle(press(Key::home));
  EXPECT_FLOAT_EQ(state().window_offset_db, first_.window_offset_db);
}

TEST_F(Controller, what_is_shown_is_turned_on_and_off) {
  choose(Action::vessels);
  turn(-1);
  EXPECT_EQ(state().vessels, VesselsShown::off);
  EXPECT_EQ(echo(), "none loaded");
  actions().set_vessels_loaded(true);
  turn(1);
  EXPECT_EQ(state().vessels, VesselsShown::both);
  EXPECT_EQ(echo(), "shown");
  choose(Action::box);
  turn(-1);
  EXPECT_FALSE(state().box_visible);
  EXPECT_EQ(echo(), "hidden");
  choose(Action::legend);
  turn(1);
  EXPECT_TRUE(state().legend_visible);
  EXPECT_FALSE(state().legend_of_keys);
  EXPECT_FALSE(state().frozen);
}

// Both at once are no chord: one foot that touches two switches does nothing unforeseen.
TEST_F(Controller, two_switches_at_once_are_two_presses) {
  tread({0, 2});
  EXPECT_EQ(state().selected, Action::b_scan) << "back and forth";
  EXPECT_FALSE(state().legend_visible);
}

TEST_F(Controller, a_held_switch_lends_the_knob_another_meaning) {
  turn_while_held({0}, 2);
  EXPECT_EQ(state().selected, Action::window_offset) << "two functions on";
  turn_while_held({1}, 2);
  EXPECT_FLOAT_EQ(state().yaw_deg, first_.yaw_deg + 6);
  turn_while_held({2}, -1);
  EXPECT_EQ(state().layout, LayoutKind::quad) << "round the other way";
  EXPECT_EQ(echo(), "quad");
  EXPECT_EQ(state().selected, Action::window_offset) << "the pedals meant nothing else";
  EXPECT_FALSE(state().frozen);
}

TEST_F(Controller, turning_a_mark_shows_the_calliper) {
  choose(Action::mark_2_depth);
  EXPECT_FALSE(state().calliper);
  turn(-1000);
  EXPECT_TRUE(state().calliper);
  EXPECT_EQ(state().mark_2_depth, 0);
  choose(Action::calliper);
  turn(-1);
  EXPECT_FALSE(state().calliper);
}

TEST_F(Controller, spun_fast_the_knob_goes_farther_but_a_choice_goes_step_by_step) {
  choose(Action::window_offset);
  for (int i = 0; i < 20; ++i) {
    now_ += milliseconds{5};
    turn(1);
  }
  EXPECT_GT(state().window_offset_db, first_.window_offset_db + 60);
  EXPECT_EQ(state().window_offset_db, std::round(state().window_offset_db));
  move(2, 1);
  for (int i = 0; i < 6; ++i) {
    now_ += milliseconds{5};
    turn(1);
  }
  EXPECT_EQ(state().layout, LayoutKind::microscope) << "six steps of four";
}

TEST(Puck, turns_at_a_rate_and_stops_when_it_is_let_go) {
  ViewController controller{{}, geometry, profile_of("space_mouse")};
  const float before = controller.state().yaw_deg;
  controller.advance(now);
  const auto push = [&](int axis, int value, hal::Duration after) {
    return controller.handle(
        ControlEvent{now + after, ControlKind::axis, static_cast<std::uint8_t>(axis), value});
  };
  push(5, 60, milliseconds{0});
  controller.advance(now + milliseconds{100});
  EXPECT_EQ(controller.state().yaw_deg, before) << "the dead zone";
  push(5, 1000, milliseconds{100});
  for (int ms = 110; ms <= 600; ms += 10)
    controller.advance(now + milliseconds{ms});
  EXPECT_NEAR(controller.state().yaw_deg, before + 60, 0.01) << "0.5 s at 40 detents of 3°";
  push(5, 0, milliseconds{600});
  controller.advance(now + seconds{2});
  EXPECT_NEAR(controller.state().yaw_deg, before + 60, 0.01);
  EXPECT_EQ(controller.actions().counts()[index_of(Action::rotate)], 1U) << "one push";
  push(5, -1000, seconds{3});
  controller.advance(now + seconds{60});
  EXPECT_NEAR(controller.state().yaw_deg, before + 60 - 12, 0.01)
      << "a display that stood still does not leap";
}

TEST(SingleKnob, goes_through_all_functions_and_does_each) {
  ViewController controller{{}, geometry, profile_of("powermate")};
  hal::TimePoint t = now;
  const auto button = [&](int value) {
    t += milliseconds{20};
    return controller.handle(ControlEvent{t, ControlKind::pedal_switch, 0, value});
  };
  const auto turn = [&](int detents) { // slowly: a unit is four of them
    for (int i = 0; i < std::abs(detents); ++i) {
      t += milliseconds{200};
      controller.handle(ControlEvent{t, ControlKind::knob, 0, detents > 0 ? 1 : -1});
    }
  };
  const auto select = [&](Action action) {
    for (int i = 0; i < 60 && controller.state().selected != action; ++i) {
      button(1);
      turn(4);
      button(0);
    }
    ASSERT_EQ(controller.state().selected, action);
  };
  const auto long_press = [&] {
    ControlRequests requests = button(1);
    t += milliseconds{700};
    requests.add(controller.advance(t));
    requests.add(button(0));
    return requests;
  };
  select(Action::snapshot);
  turn(8);
  EXPECT_EQ(controller.state().echo.words.view(), "press to do it");
  EXPECT_TRUE(long_press().snapshot);
  select(Action::box);
  turn(-4);
  EXPECT_FALSE(controller.state().box_visible) << "left is off";
  turn(-4);
  EXPECT_FALSE(controller.state().box_visible) << "and stays so";
  turn(5);
  EXPECT_TRUE(controller.state().box_visible);
  long_press();
  EXPECT_FALSE(controller.state().box_visible);
  select(Action::tilt);
  turn(8);
  EXPECT_FLOAT_EQ(controller.state().tilt_deg, ViewState{}.tilt_deg + 6);
}

TEST(HeldSwitch, repeats_what_it_does) {
  ViewController controller{{},
                            geometry,
                            parsed("name = \"x\"\n[[bind]]\nswitch = 0\ngesture = \"hold\"\n"
                                   "action = \"tilt\"\nstep = -1\n")};
  controller.handle(ControlEvent{now, ControlKind::pedal_switch, 0, 1});
  EXPECT_FLOAT_EQ(controller.state().tilt_deg, ViewState{}.tilt_deg - 3);
  controller.advance(now + milliseconds{399});
  EXPECT_FLOAT_EQ(controller.state().tilt_deg, ViewState{}.tilt_deg - 3);
  EXPECT_EQ(controller.next_deadline(), now + milliseconds{400});
  controller.advance(now + milliseconds{500});
  EXPECT_FLOAT_EQ(controller.state().tilt_deg, ViewState{}.tilt_deg - 9);
}

TEST_F(Controller, each_key_of_a_choice_goes_on_and_with_shift_back) {
  actions().set_choices({{"window", "steep", "soft"}, {"grey", "viridis", "hot"}});
  const auto there_and_back = [&](char key, auto member) {
    const auto before = state().*member;
    controller_.handle(press(static_cast<std::uint16_t>(key)));
    EXPECT_NE(state().*member, before) << key;
    controller_.handle(press(static_cast<std::uint16_t>(key), true));
    EXPECT_EQ(state().*member, before) << key;
  };
  there_and_back('t', &ViewState::technique);
  there_and_back('f', &ViewState::transfer);
  there_and_back('c', &ViewState::colour_map);
  there_and_back('l', &ViewState::layout);
  there_and_back('d', &ViewState::stereo);
  controller_.handle(press('v'));
  EXPECT_EQ(state().vessels, VesselsShown::off);
  controller_.handle(press(Key::f1));
  EXPECT_TRUE(state().legend_visible);
  EXPECT_TRUE(state().legend_of_keys);
  controller_.handle(press('h'));
  EXPECT_FALSE(state().legend_visible);
  controller_.handle(press(Key::tab));
  EXPECT_EQ(state().selected, Action::crossed_b_scan);
  EXPECT_TRUE(controller_.handle(press('w')).auto_window);
  EXPECT_TRUE(controller_.handle(press('r')).record);
}

TEST_F(Controller, home_restores_the_view_but_does_not_thaw) {
  controller_.handle(press(Key::right));
  controller_.handle(press('b'));
  EXPECT_FALSE(state().box_visible);
  controller_.handle(press(Key::space));
  controller_.handle(press(Key::home));
  EXPECT_EQ(state().yaw_deg, first_.yaw_deg);
  EXPECT_TRUE(state().box_visible);
  EXPECT_TRUE(state().frozen);
  EXPECT_EQ(state().frozen_since, now);
}

TEST_F(Controller, asks_the_host_to_quit_and_to_keep_a_picture) {
  EXPECT_TRUE(controller_.handle(press(Key::escape)).quit);
  EXPECT_TRUE(controller_.handle(press('q')).quit);
  EXPECT_TRUE(controller_.handle(DisplayEvent{}).quit) << "the close button";
  EXPECT_TRUE(controller_.handle(press('p')).snapshot);
  EXPECT_EQ(controller_.handle(press(Key::left)), ControlRequests{});
  DisplayEvent released = press('q');
  released.kind = DisplayEventKind::key_released;
  EXPECT_EQ(controller_.handle(released), ControlRequests{});
}

TEST_F(Controller, another_device_brings_its_own_profile_and_finds_the_view_as_it_was) {
  turn(3);
  move(0, 1); // held while it is pulled out
  const ViewState before = state();
  controller_.change_profile(parsed(R"(
name = "Wheel"
menu = ["tilt"]
[device]
switches = ["top"]
[[bind]]
switch = "top"
gesture = "press"
action = "freeze"
[[bind]]
knob = 0
action = "adjust"
)"));
  EXPECT_EQ(state().window_offset_db, before.window_offset_db);
  EXPECT_EQ(state().selected, Action::tilt) << "the old menu's choice is not in the new one";
  EXPECT_FALSE(state().frozen);
  wait(seconds{2});
  EXPECT_EQ(count(Action::technique), 0U) << "what was held on the old device means nothing";
  tread({0});
  EXPECT_TRUE(state().frozen);
}

} // namespace
} // namespace octascope::ui
