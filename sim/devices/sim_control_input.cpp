#include "sim/devices/sim_control_input.h"

#include <algorithm>

namespace octascope::sim {

using hal::ControlEvent;
using hal::ControlKind;
using hal::DeviceState;
using hal::ErrorCode;
using hal::TimePoint;
using pipeline::Fault;
using namespace std::chrono_literals;

SimControlInput::SimControlInput(hal::Clock& clock, ControlScript script,
                                 const FaultSchedule* faults)
    : clock_(clock), script_(std::move(script)), cursor_(script_),
      probe_(faults, pipeline::Device::control_input) {}

bool SimControlInput::inject(const ControlEvent& event) {
  return is_plausible(event) && injected_.push(event);
}

hal::Result<> SimControlInput::do_open() {
  const TimePoint now = clock_.now();
  if (probe_.unplugged(now))
    return hal::fail(ErrorCode::absent,
                     "simulated control input: not found, expected it in its "
                     "socket; the fault script has unplugged it, try again later");
  probe_.watch_plug(now);
  if (!zero_)
    zero_ = last_reported_ = now;
  // What was done to the pedal before is unseen.
  next_injected_.reset();
  while (injected_.pop()) {
  }
  for (auto due = cursor_.next_time(); due && *zero_ + *due < now; due = cursor_.next_time())
    cursor_.take();
  for (BouncingContact& contact : contacts_)
    contact.reset();
  axes_ = {};
  oldest_ = reported_ = 0;
  pulled_out_ = false;
  played_to_ = now;
  play_moment(now);
  set_state(DeviceState::ready);
  return {};
}

hal::Result<std::size_t> SimControlInput::do_read(std::span<ControlEvent> events,
                                                  hal::Duration timeout) {
  TimePoint now = clock_.now();
  const TimePoint deadline = hal::deadline_after(now, timeout);
  while (true) {
    play_to(now);
    if (const std::size_t fetched = fetch(events); fetched > 0)
      return fetched;
    if (pulled_out_ && reported_ == 0) {
      set_state(DeviceState::failed);
      return hal::fail(ErrorCode::disconnected,
                       "simulated control input: it went away while in use; the fault script has "
                       "unplugged it, close it and open it again");
    }
    if (events.empty() || now >= deadline)
      return std::size_t{0};
    // Injected events come from other threads: looked for every millisecond, a fraction of the
    // refresh that will show their effect.
    clock_.sleep_until(std::min({deadline, next_moment(), now + 1ms}));
    now = clock_.now();
  }
}

std::uint64_t SimControlInput::do_bounces() const {
  std::uint64_t sum = 0;
  for (const BouncingContact& contact : contacts_)
    sum += contact.bounces();
  return sum;
}

void SimControlInput::do_close() {
  set_state(DeviceState::absent);
}

void SimControlInput::play_to(TimePoint now) {
  if (pulled_out_ || !play_timeline(now))
    return;
  if (probe_.pulled_since_last_look(now)) {
    pull_out(now);
    return;
  }
  update_stuck_switches(now);
}

// False when the device is gone or the outbox is full before `now`.
bool SimControlInput::play_timeline(TimePoint now) {
  for (look_for_injected(now); next_moment() <= now; look_for_injected(now)) {
    if (!has_room())
      return false;
    played_to_ = std::max(played_to_, next_moment());
    play_moment(played_to_);
    if (pulled_out_)
      return false;
  }
  played_to_ = now;
  return true;
}

TimePoint SimControlInput::next_moment() const {
  TimePoint next = TimePoint::max();
  const auto consider = [&](std::optional<TimePoint> t) {
    next = std::min(next, t.value_or(next));
  };
  if (const auto due = cursor_.next_time())
    consider(*zero_ + *due);
  for (const BouncingContact& contact : contacts_)
    consider(contact.next_time());
  if (next_injected_)
    consider(next_injected_->time);
  consider(probe_.next_edge(gone(pipeline::Device::control_input), played_to_));
  consider(probe_.next_edge(Fault::stuck_switch, played_to_));
  return next;
}

void SimControlInput::play_moment(TimePoint t) {
  if (probe_.unplugged(t)) {
    pull_out(t);
    return;
  }
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    if (const auto change = contacts_[i].play_to(t))
      report({change->time, ControlKind::pedal_switch, static_cast<std::uint8_t>(i),
              change->closed ? 1 : 0});
  }
  update_stuck_switches(t);
  play_script(t);
  play_injected(t);
}

// One event at most: others due at the same time are a moment of their own.
void SimControlInput::play_script(TimePoint t) {
  const auto due = cursor_.next_time();
  if (!due || *zero_ + *due > t)
    return;
  const ScriptedControl& event = cursor_.take();
  move(t, event.kind, event.index, event.value);
}

void SimControlInput::look_for_injected(TimePoint now) {
  if (next_injected_)
    return;
  next_injected_ = injected_.pop();
  if (next_injected_) // what is said to come later than now has come
    next_injected_->time = std::min(next_injected_->time, now);
}

void SimControlInput::play_injected(TimePoint t) {
  if (!next_injected_ || next_injected_->time > t)
    return;
  move(t, next_injected_->kind, next_injected_->index, next_injected_->value);
  next_injected_.reset();
}

void SimControlInput::update_stuck_switches(TimePoint t) {
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    const ScriptedFault* stuck = probe_.active(Fault::stuck_switch, t, static_cast<int>(i));
    contacts_[i].stick(t, stuck == nullptr ? std::nullopt : std::optional{stuck->stuck_pressed});
  }
}

void SimControlInput::move(TimePoint t, ControlKind what, std::uint8_t index, std::int32_t value) {
  if (what == ControlKind::pedal_switch) {
    contacts_[index].foot(t, value != 0, probe_.active(Fault::bounce, t, index));
    return;
  }
  if (what == ControlKind::axis)
    axes_[index] = value;
  report({t, what, index, value});
}

void SimControlInput::pull_out(TimePoint t) {
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    if (contacts_[i].reported())
      report({t, ControlKind::pedal_switch, static_cast<std::uint8_t>(i), 0});
  }
  for (std::size_t i = 0; i < axes_.size(); ++i)
    if (axes_[i] != 0)
      report({t, ControlKind::axis, static_cast<std::uint8_t>(i), 0});
  pulled_out_ = true;
}

void SimControlInput::report(const ControlEvent& event) {
  ControlEvent& place = outbox_[(oldest_ + reported_) % outbox_.size()];
  place = event;
  // A press is certain only when it has rested; a knob that turned meanwhile was told before it.
  place.time = last_reported_ = std::max(last_reported_, event.time);
  ++reported_;
}

std::size_t SimControlInput::fetch(std::span<ControlEvent> events) {
  const std::size_t fetched = std::min(events.size(), reported_);
  for (std::size_t i = 0; i < fetched; ++i)
    events[i] = outbox_[(oldest_ + i) % outbox_.size()];
  oldest_ = (oldest_ + fetched) % outbox_.size();
  reported_ -= fetched;
  return fetched;
}

} // namespace octascope::sim
