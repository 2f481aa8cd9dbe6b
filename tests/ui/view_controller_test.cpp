#include <gtest/gtest.h>

#include "ui/controls/simulated_control.h"
#include "ui/controls/view_controller.h"

namespace octascope::ui {
namespace {

using hal::ControlEvent;
using hal::ControlKind;
using hal::DisplayEvent;
using hal::DisplayEventKind;
using hal::Key;
using std::chrono::seconds;

constexpr hal::TimePoint now{seconds{50}};

DisplayEvent press(std::uint16_t key, bool shift = false, bool repeated = false) {
  return {DisplayEventKind::key_pressed, key, repeated, shift, now};
}
DisplayEvent press(Key key) {
  return press(static_cast<std::uint16_t>(key));
}

class Controller : public testing::Test {
protected:
  const ViewState first_;
  ViewController controller_{first_, 80};
  const ViewState& state() const { return controller_.state(); }
};

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
}

TEST_F(Controller, values_stop_at_their_ends_and_yaw_goes_round) {
  for (int i = 0; i < 500; ++i) {
    controller_.handle(press(']'));
    controller_.handle(press(Key::up));
    controller_.handle(press(Key::right));
  }
  EXPECT_EQ(state().b_scan, 79);
  EXPECT_FLOAT_EQ(state().tilt_deg, 89);
  EXPECT_LE(std::abs(state().yaw_deg), 180);
  controller_.set_b_scans(20);
  EXPECT_EQ(state().b_scan, 19);
}

TEST_F(Controller, space_and_the_centre_switch_freeze_with_their_time) {
  controller_.handle(press(Key::space));
  EXPECT_TRUE(state().frozen);
  EXPECT_EQ(state().frozen_since, now);
  controller_.handle(press(static_cast<std::uint16_t>(Key::space), false, true));
  EXPECT_TRUE(state().frozen) << "a key held down does not flicker";
  controller_.handle(ControlEvent{now + seconds{3}, ControlKind::pedal_switch, 1, 1});
  EXPECT_FALSE(state().frozen);
  controller_.handle(ControlEvent{now + seconds{4}, ControlKind::pedal_switch, 1, 0});
  EXPECT_FALSE(state().frozen) << "letting go does nothing";
}

TEST_F(Controller, pedal_chooses_what_the_knob_turns_and_the_display_echoes_it) {
  EXPECT_EQ(state().selected, Parameter::window_offset);
  controller_.handle(ControlEvent{now, ControlKind::pedal_switch, 2, 1});
  EXPECT_EQ(state().selected, Parameter::window_size);
  EXPECT_GT(state().echo_until, now);
  controller_.handle(ControlEvent{now + seconds{9}, ControlKind::knob, 0, 4});
  EXPECT_FLOAT_EQ(state().window_size_db, first_.window_size_db + 4);
  EXPECT_GT(state().echo_until, now + seconds{9});
  for (int i = 0; i < parameter_count - 1; ++i)
    controller_.handle(ControlEvent{now, ControlKind::pedal_switch, 2, 1});
  EXPECT_EQ(state().selected, Parameter::window_offset) << "round again";
  controller_.handle(ControlEvent{now, ControlKind::pedal_switch, 0, 1});
  EXPECT_EQ(state().selected, Parameter::b_scan);
  controller_.handle(ControlEvent{now, ControlKind::knob, 0, -2});
  EXPECT_EQ(state().b_scan, first_.b_scan - 2);
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

TEST(SimulatedControl, digits_are_switches_and_comma_and_stop_turn_the_knob) {
  EXPECT_EQ(simulated_control(press('2')), (ControlEvent{now, ControlKind::pedal_switch, 1, 1}));
  DisplayEvent released = press('3');
  released.kind = DisplayEventKind::key_released;
  EXPECT_EQ(simulated_control(released), (ControlEvent{now, ControlKind::pedal_switch, 2, 0}));
  EXPECT_EQ(simulated_control(press(',')), (ControlEvent{now, ControlKind::knob, 0, -1}));
  EXPECT_EQ(simulated_control(press('.', false, true)),
            (ControlEvent{now, ControlKind::knob, 0, 1}));
  EXPECT_FALSE(simulated_control(press('1', false, true))) << "a switch held down is one press";
  EXPECT_FALSE(simulated_control(press('4')));
  EXPECT_FALSE(simulated_control(press('o')));
}

} // namespace
} // namespace octascope::ui
