// Converts operator input into view states. Pure: no clock, no device, no thread of its own.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "hal/control_input.h"
#include "hal/display.h"
#include "ui/controls/control_profile.h"
#include "ui/controls/gesture_recogniser.h"
#include "ui/controls/knob_acceleration.h"
#include "ui/controls/view_actions.h"
#include "ui/view/view_state.h"

namespace octascope::ui {

// Keys: ui/controls/key_bindings.h; escape and q quit. Pedals, knobs and sticks: the profile.
//
// Threads: one at a time, the render thread. Call advance() every frame: long presses, repetitions
// and sticks depend on it.
class ViewController {
public:
  // `initial` is the state that reset_view restores; `volume` limits positions in it.
  ViewController(const ViewState& initial, const Geometry& volume, ControlProfile profile,
                 ChoiceNames names = {});

  // Switches to the profile of another device. The view stays; no switch counts as held.
  void change_profile(ControlProfile profile);

  const ViewState& state() const { return actions_.state(); }

  // For the host: the names of choices, the window it found, the echo of a request.
  ViewActions& actions() { return actions_; }
  const ViewActions& actions() const { return actions_; }

  ControlRequests handle(const hal::DisplayEvent& event);
  ControlRequests handle(const hal::ControlEvent& event);
  ControlRequests advance(hal::TimePoint now);

  // When advance() will next do something, if no event comes before. (While a stick is pushed,
  // advance() changes the view every frame.)
  std::optional<hal::TimePoint> next_deadline() const { return recogniser_.next_deadline(); }

private:
  struct Knob {
    KnobMotion motion;
    std::optional<Action> action; // the last action that it turned
    double rest = 0;              // fraction of a unit not yet applied
  };

  ControlRequests perform_told();
  ControlRequests turn(const hal::ControlEvent& event);
  ControlRequests turn(Knob& knob, const KnobAction& bound, const hal::ControlEvent& event);
  ControlRequests push(const hal::ControlEvent& event);
  Action target(Action action) const;

  ControlProfile profile_;
  ViewActions actions_;
  GestureRecogniser recogniser_;
  std::vector<Gesture> told_;
  std::array<Knob, most_knobs> knobs_{};
  std::array<std::int32_t, axis_count> axes_{}; // deflection of each
  std::optional<hal::TimePoint> advanced_;
};

} // namespace octascope::ui
