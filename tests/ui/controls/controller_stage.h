// What a foot and a hand do, and what becomes of the view.
#pragma once

#include <initializer_list>
#include <string_view>
#include <utility>

#include <gtest/gtest.h>

#include "ui/controls/built_in_profiles.h"
#include "ui/controls/view_controller.h"

namespace octascope::ui {

using hal::ControlEvent;
using hal::ControlKind;
using hal::DisplayEvent;
using hal::DisplayEventKind;
using hal::Key;
using std::chrono::milliseconds;
using std::chrono::seconds;

inline constexpr hal::TimePoint now{seconds{50}};
inline constexpr Geometry geometry{512, 300, 80};

inline DisplayEvent press(std::uint16_t key, bool shift = false, bool repeated = false) {
  return {DisplayEventKind::key_pressed, key, repeated, shift, now};
}
inline DisplayEvent press(Key key) {
  return press(static_cast<std::uint16_t>(key));
}

inline ControlProfile profile_of(std::string_view name) {
  auto profile = built_in_profile(name);
  EXPECT_TRUE(profile) << profile.error().message;
  return std::move(*profile);
}

inline ControlProfile parsed(std::string_view text) {
  auto profile = ControlProfile::parse(text, "test.toml");
  EXPECT_TRUE(profile) << profile.error().message;
  return std::move(*profile);
}

// The default profile: three switches and a knob.
class Controller : public testing::Test {
protected:
  const ViewState first_;
  ViewController controller_{first_, geometry, profile_of(default_profile)};
  hal::TimePoint now_ = now;

  const ViewState& state() const { return controller_.state(); }
  ViewActions& actions() { return controller_.actions(); }
  std::uint64_t count(Action action) const {
    return controller_.actions().counts()[index_of(action)];
  }

  ControlRequests move(std::uint8_t index, int value) {
    return controller_.handle(ControlEvent{now_, ControlKind::pedal_switch, index, value});
  }
  ControlRequests turn(int detents) {
    return controller_.handle(ControlEvent{now_, ControlKind::knob, 0, detents});
  }
  ControlRequests wait(hal::Duration time) {
    now_ += time;
    return controller_.advance(now_);
  }
  // Down together, and up after so long; then at rest for long.
  ControlRequests tread(std::initializer_list<std::uint8_t> switches,
                        hal::Duration held = milliseconds{150}) {
    ControlRequests requests;
    for (const std::uint8_t index : switches)
      requests.add(move(index, 1));
    requests.add(wait(held));
    for (const std::uint8_t index : switches)
      requests.add(move(index, 0));
    requests.add(wait(seconds{1}));
    return requests;
  }
  void turn_while_held(std::initializer_list<std::uint8_t> switches, int detents) {
    for (const std::uint8_t index : switches)
      move(index, 1);
    wait(seconds{1});
    turn(detents);
    wait(seconds{1});
    for (const std::uint8_t index : switches)
      move(index, 0);
    wait(seconds{1});
  }
  // As a foot and a hand do it, whatever the knob turned before.
  void choose(Action action) {
    move(0, 1);
    for (std::size_t i = 0; i < action_count && state().selected != action; ++i)
      turn(1);
    move(0, 0);
    wait(seconds{1});
    ASSERT_EQ(state().selected, action);
  }
  std::string_view echo() const { return state().echo.words.view(); }
};

} // namespace octascope::ui
