#include <chrono>

#include <gtest/gtest.h>

#include "ui/controls/simulated_control.h"

namespace octascope::ui {
namespace {

using hal::ControlEvent;
using hal::ControlKind;
using hal::DisplayEvent;
using hal::DisplayEventKind;

constexpr hal::TimePoint typed_at{std::chrono::seconds{50}};

DisplayEvent typed(std::uint16_t key, bool repeated = false) {
  return {DisplayEventKind::key_pressed, key, repeated, false, typed_at};
}

TEST(SimulatedControl, digits_are_switches_and_comma_and_stop_turn_the_knob) {
  EXPECT_EQ(simulated_control(typed('2')),
            (ControlEvent{typed_at, ControlKind::pedal_switch, 1, 1}));
  DisplayEvent released = typed('3');
  released.kind = DisplayEventKind::key_released;
  EXPECT_EQ(simulated_control(released), (ControlEvent{typed_at, ControlKind::pedal_switch, 2, 0}));
  EXPECT_EQ(simulated_control(typed(',')), (ControlEvent{typed_at, ControlKind::knob, 0, -1}));
  EXPECT_EQ(simulated_control(typed('.', true)), (ControlEvent{typed_at, ControlKind::knob, 0, 1}));
  EXPECT_FALSE(simulated_control(typed('1', true))) << "a switch held down is one press";
  EXPECT_FALSE(simulated_control(typed('4')));
  EXPECT_FALSE(simulated_control(typed('o')));
}

} // namespace
} // namespace octascope::ui
