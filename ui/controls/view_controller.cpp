#include "ui/controls/view_controller.h"

#include <algorithm>
#include <cmath>

#include "ui/controls/key_bindings.h"

namespace octascope::ui {

namespace {

constexpr std::size_t most_told_at_once = 64; // more would only cost an allocation

// A display that stands still for longer must not let the view leap afterwards.
constexpr hal::Duration longest_frame = std::chrono::milliseconds{100};

bool is_quit(const hal::DisplayEvent& event) {
  return event.kind == hal::DisplayEventKind::close_requested ||
         (event.kind == hal::DisplayEventKind::key_pressed && !event.repeated &&
          (event.key == 'q' || event.key == static_cast<std::uint16_t>(hal::Key::escape)));
}

} // namespace

ViewController::ViewController(const ViewState& initial, const Geometry& volume,
                               ControlProfile profile, ChoiceNames names)
    : profile_{std::move(profile)}, actions_{initial, volume, profile_.menu, std::move(names)},
      recogniser_{profile_.switch_bindings(), profile_.times} {
  told_.reserve(most_told_at_once);
}

void ViewController::change_profile(ControlProfile profile) {
  profile_ = std::move(profile);
  actions_.change_menu(profile_.menu);
  recogniser_ = GestureRecogniser{profile_.switch_bindings(), profile_.times};
  told_.clear();
  knobs_ = {};
  axes_ = {};
}

ControlRequests ViewController::handle(const hal::DisplayEvent& event) {
  ControlRequests requests;
  requests.quit = is_quit(event);
  if (event.kind != hal::DisplayEventKind::key_pressed)
    return requests;
  const auto bound = binding_of(event.key);
  if (!bound || (event.repeated && !bound->repeats))
    return requests;
  if (bound->action == Action::legend)
    actions_.show_keys_in_legend(true);
  requests.add(actions_.perform(bound->action, event.shift ? bound->shifted : bound->step,
                                Done::pressed, event.time));
  return requests;
}

ControlRequests ViewController::handle(const hal::ControlEvent& event) {
  switch (event.kind) {
  case hal::ControlKind::pedal_switch:
    recogniser_.handle(event.index, event.value != 0, event.time, told_);
    return perform_told();
  case hal::ControlKind::knob: return turn(event);
  case hal::ControlKind::axis: return push(event);
  }
  return {};
}

ControlRequests ViewController::perform_told() {
  ControlRequests requests;
  for (const Gesture& gesture : told_)
    for (const SwitchAction& bound : profile_.switch_actions) {
      if (bound.switches != gesture.switches || bound.gesture != gesture.kind)
        continue;
      if (target(bound.action) == Action::legend)
        actions_.show_keys_in_legend(false);
      requests.add(actions_.perform(bound.action, bound.step, Done::pressed, gesture.time));
    }
  told_.clear();
  return requests;
}

Action ViewController::target(Action action) const {
  return action == Action::adjust ? state().selected : action;
}

// A knob that is not bound with the switches that are held does what it does without them.
ControlRequests ViewController::turn(const hal::ControlEvent& event) {
  if (event.index >= most_knobs || event.value == 0)
    return {};
  const SwitchSet held = recogniser_.modify(event.time, told_);
  ControlRequests requests = perform_told();
  const KnobAction* plain = nullptr;
  const KnobAction* modified = nullptr;
  for (const KnobAction& bound : profile_.knob_actions) {
    if (bound.knob != event.index)
      continue;
    if (bound.while_held == 0)
      plain = &bound;
    else if (bound.while_held == held)
      modified = &bound;
  }
  if (const KnobAction* bound = modified != nullptr ? modified : plain)
    requests.add(turn(knobs_[event.index], *bound, event));
  return requests;
}

// Only whole units act, so that values stay round. What is not continuous goes by detents: nobody
// can choose among four at eight times the speed.
ControlRequests ViewController::turn(Knob& knob, const KnobAction& bound,
                                     const hal::ControlEvent& event) {
  const Action action = target(bound.action);
  const std::int8_t direction = event.value > 0 ? std::int8_t{1} : std::int8_t{-1};
  // What was spun fast to choose a function does not make the function's own turn fast.
  if (knob.action != action)
    knob.motion = {};
  if (knob.action != action || knob.motion.direction != direction)
    knob.rest = 0;
  knob.action = action;
  knob.motion = knob.motion.turned(event.value, profile_.detents_per_turn, event.time);
  const bool accelerates = kind_of(action) == ActionKind::continuous;
  knob.rest += accelerates ? knob.motion.units : slow_units(event.value, profile_.detents_per_turn);
  const double whole = std::trunc(knob.rest);
  knob.rest -= whole;
  if (whole == 0)
    return {};
  if (action == Action::legend)
    actions_.show_keys_in_legend(false);
  return actions_.perform(bound.action, whole * bound.step, Done::turned, event.time);
}

// As far as it was pushed until now, it has moved the view.
ControlRequests ViewController::push(const hal::ControlEvent& event) {
  if (event.index >= axis_count)
    return {};
  const ControlRequests requests = advance(event.time);
  const bool begins = axis_response(axes_[event.index]) == 0 && axis_response(event.value) != 0;
  axes_[event.index] = event.value;
  for (const AxisAction& bound : profile_.axis_actions)
    if (begins && bound.axis == event.index)
      actions_.begin_driving(bound.action, event.time);
  return requests;
}

ControlRequests ViewController::advance(hal::TimePoint now) {
  recogniser_.advance(now, told_);
  const ControlRequests requests = perform_told();
  const hal::Duration passed =
      std::clamp(now - advanced_.value_or(now), hal::Duration{}, longest_frame);
  advanced_ = std::max(advanced_.value_or(now), now);
  for (const AxisAction& bound : profile_.axis_actions)
    if (const double response = axis_response(axes_[bound.axis]); response != 0)
      actions_.drive(bound.action, response * bound.per_second * hal::to_seconds(passed), now);
  return requests;
}

} // namespace octascope::ui
