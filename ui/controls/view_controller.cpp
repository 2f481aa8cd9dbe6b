#include "ui/controls/view_controller.h"

#include <algorithm>
#include <cmath>

namespace octascope::ui {

namespace {

constexpr hal::Duration echo_duration = std::chrono::milliseconds{2500};
constexpr std::uint8_t left_switch = 0;
constexpr std::uint8_t centre_switch = 1;
constexpr std::uint8_t right_switch = 2;

constexpr std::uint16_t code(hal::Key key) {
  return static_cast<std::uint16_t>(key);
}

void set_parameter(ViewState& view, Parameter parameter, float value) {
  switch (parameter) {
  case Parameter::window_offset: view.window_offset_db = value; break;
  case Parameter::window_size: view.window_size_db = value; break;
  case Parameter::yaw: view.yaw_deg = value; break;
  case Parameter::tilt: view.tilt_deg = value; break;
  case Parameter::distance: view.distance = value; break;
  case Parameter::b_scan: view.b_scan = static_cast<int>(std::lround(value)); break;
  }
}

} // namespace

ViewController::ViewController(const ViewState& initial, int b_scans)
    : initial_{initial.clamped()}, state_{initial_}, b_scans_{b_scans} {
  set_b_scans(b_scans);
}

void ViewController::set_b_scans(int b_scans) {
  b_scans_ = std::max(b_scans, 1);
  state_.b_scan = std::min(state_.b_scan, b_scans_ - 1);
}

void ViewController::set_window(float offset_db, float size_db) {
  for (ViewState* view : {&initial_, &state_}) {
    view->window_offset_db = offset_db;
    view->window_size_db = size_db;
    *view = view->clamped();
  }
}

void ViewController::turn(Parameter parameter, float detents, hal::TimePoint time) {
  const ParameterRange range = parameter_range(parameter, b_scans_);
  set_parameter(state_, parameter, parameter_value(state_, parameter) + detents * range.detent);
  state_ = state_.clamped();
  state_.b_scan = std::min(state_.b_scan, b_scans_ - 1);
  state_.selected = parameter;
  state_.echo_until = time + echo_duration;
}

void ViewController::select_next(int step, hal::TimePoint time) {
  const int next = (static_cast<int>(state_.selected) + step + parameter_count) % parameter_count;
  state_.selected = static_cast<Parameter>(next);
  state_.echo_until = time + echo_duration;
}

void ViewController::toggle_freeze(hal::TimePoint time) {
  state_.frozen = !state_.frozen;
  state_.frozen_since = state_.frozen ? time : hal::TimePoint{};
}

// A frozen picture stays frozen: looking at it afresh must not let it run away.
void ViewController::go_home() {
  const ViewState old = state_;
  state_ = initial_;
  state_.frozen = old.frozen;
  state_.frozen_since = old.frozen_since;
  state_.selected = old.selected;
  state_.b_scan = std::min(state_.b_scan, b_scans_ - 1);
}

ControlRequests ViewController::handle(const hal::DisplayEvent& event) {
  ControlRequests requests;
  if (event.kind == hal::DisplayEventKind::close_requested)
    requests.quit = true;
  if (event.kind != hal::DisplayEventKind::key_pressed)
    return requests;
  const float up_with_shift = event.shift ? 1.0F : -1.0F;
  switch (event.key) {
  case code(hal::Key::left): turn(Parameter::yaw, -1, event.time); break;
  case code(hal::Key::right): turn(Parameter::yaw, 1, event.time); break;
  case code(hal::Key::up): turn(Parameter::tilt, 1, event.time); break;
  case code(hal::Key::down): turn(Parameter::tilt, -1, event.time); break;
  case code(hal::Key::page_up):
  case '+':
  case '=': turn(Parameter::distance, -1, event.time); break;
  case code(hal::Key::page_down):
  case '-': turn(Parameter::distance, 1, event.time); break;
  case 'o': turn(Parameter::window_offset, up_with_shift, event.time); break;
  case 's': turn(Parameter::window_size, up_with_shift, event.time); break;
  case '[': turn(Parameter::b_scan, -1, event.time); break;
  case ']': turn(Parameter::b_scan, 1, event.time); break;
  default: break;
  }
  if (event.repeated) // switches act once a press
    return requests;
  switch (event.key) {
  case 'b': state_.box_visible = !state_.box_visible; break;
  case code(hal::Key::space): toggle_freeze(event.time); break;
  case code(hal::Key::home): go_home(); break;
  case 'p': requests.snapshot = true; break;
  case code(hal::Key::escape):
  case 'q': requests.quit = true; break;
  default: break;
  }
  return requests;
}

ControlRequests ViewController::handle(const hal::ControlEvent& event) {
  if (event.kind == hal::ControlKind::knob)
    turn(state_.selected, static_cast<float>(event.value), event.time);
  if (event.kind == hal::ControlKind::pedal_switch && event.value != 0) {
    switch (event.index) {
    case left_switch: select_next(-1, event.time); break;
    case centre_switch: toggle_freeze(event.time); break;
    case right_switch: select_next(1, event.time); break;
    default: break;
    }
  }
  return {};
}

} // namespace octascope::ui
