// Turns what hands and feet do into view states. Pure: no clock, no device, no thread of its own.
#pragma once

#include "hal/control_input.h"
#include "hal/display.h"
#include "ui/view_state.h"

namespace octascope::ui {

// What an event asks of the host, beside the new view.
struct ControlRequests {
  bool quit = false;
  bool snapshot = false;
  bool operator==(const ControlRequests&) const = default;
};

// Keys: arrows orbit (left, right) and tilt (up, down) · page up, + closer · page down, − farther ·
// o, O window offset down, up · s, S window size down, up · b box · space freeze · [ ] B-scan ·
// p snapshot · home first view and window again · escape, q quit.
// Pedal: left and right choose what the knob turns, centre freezes. Knob: turns it.
//
// Threads: one at a time. The host hands state() on as an immutable snapshot.
class ViewController {
public:
  // `initial` is what the key "home" goes back to; `b_scans` bounds the B-scan's position.
  ViewController(const ViewState& initial, int b_scans);

  const ViewState& state() const { return state_; }
  void set_b_scans(int b_scans);
  // Also what "home" goes back to.
  void set_window(float offset_db, float size_db);

  ControlRequests handle(const hal::DisplayEvent& event);
  ControlRequests handle(const hal::ControlEvent& event);

private:
  void turn(Parameter parameter, float detents, hal::TimePoint time);
  void select_next(int step, hal::TimePoint time);
  void toggle_freeze(hal::TimePoint time);
  void go_home();

  ViewState initial_;
  ViewState state_;
  int b_scans_;
};

} // namespace octascope::ui
