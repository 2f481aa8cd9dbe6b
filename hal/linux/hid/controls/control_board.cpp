#include "hal/linux/hid/controls/control_board.h"

#include <algorithm>
#include <utility>

namespace octascope::hal::linux_backend {

void ControlBoard::vacate() {
  device_count_ = port_count_ = 0;
  switches_ = knobs_ = 0;
  for (SwitchDebouncer& contact : contacts_)
    contact.reset();
  axes_ = {};
}

void ControlBoard::clear() {
  vacate();
  oldest_ = waiting_ = 0;
}

std::optional<std::size_t> ControlBoard::add_device(int switches, int knobs) {
  if (device_count_ == devices_.size())
    return std::nullopt;
  const Place place{switches_, std::min(switches, most_switches - switches_), knobs_,
                    std::min(knobs, static_cast<int>(most_knobs) - knobs_)};
  switches_ += place.switches;
  knobs_ += place.knobs;
  devices_[device_count_] = place;
  return device_count_++;
}

std::optional<std::size_t> ControlBoard::add_port(std::size_t device) {
  if (port_count_ == ports_.size())
    return std::nullopt;
  ports_[port_count_] = {device, 0};
  return port_count_++;
}

void ControlBoard::note(std::size_t port, const HidReading& reading, TimePoint now) {
  const std::size_t device = ports_[port].device;
  const Place& place = devices_[device];
  if (reading.switches) {
    ports_[port].down = *reading.switches;
    std::uint32_t down = 0;
    for (std::size_t i = 0; i < port_count_; ++i)
      if (ports_[i].device == device)
        down |= ports_[i].down;
    for (int i = 0; i < place.switches; ++i)
      contacts_[static_cast<std::size_t>(place.first_switch + i)].contact(now,
                                                                          (down >> i & 1U) != 0);
  }
  if (reading.knob != 0 && place.knobs > 0)
    report(now, ControlKind::knob, static_cast<std::size_t>(place.first_knob), reading.knob);
  for (std::size_t i = 0; i < axes_.size(); ++i) {
    if ((reading.axes_told >> i & 1U) == 0 || reading.axes[i] == axes_[i])
      continue;
    axes_[i] = reading.axes[i];
    report(now, ControlKind::axis, i, axes_[i]);
  }
}

void ControlBoard::settle(TimePoint now) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(switches_); ++i)
    if (const auto change = contacts_[i].settle(now))
      report(change->time, ControlKind::pedal_switch, i, change->closed ? 1 : 0);
}

void ControlBoard::release_all(TimePoint now) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(switches_); ++i) {
    if (contacts_[i].closed())
      report(now, ControlKind::pedal_switch, i, 0);
    contacts_[i].reset();
  }
  for (std::size_t i = 0; i < axes_.size(); ++i)
    if (std::exchange(axes_[i], std::int16_t{0}) != 0)
      report(now, ControlKind::axis, i, 0);
}

std::optional<TimePoint> ControlBoard::due() const {
  std::optional<TimePoint> first;
  for (std::size_t i = 0; i < static_cast<std::size_t>(switches_); ++i)
    if (const auto due = contacts_[i].due(); due && (!first || *due < *first))
      first = due;
  return first;
}

std::size_t ControlBoard::take(std::span<ControlEvent> events) {
  const std::size_t count = std::min(events.size(), waiting_);
  for (std::size_t i = 0; i < count; ++i)
    events[i] = events_[(oldest_ + i) % events_.size()];
  oldest_ = (oldest_ + count) % events_.size();
  waiting_ -= count;
  return count;
}

std::uint64_t ControlBoard::bounces() const {
  std::uint64_t sum = 0;
  for (const SwitchDebouncer& contact : contacts_)
    sum += contact.bounces();
  return sum;
}

// A press is certain only when it has rested; a knob that turned meanwhile was told before it.
void ControlBoard::report(TimePoint t, ControlKind kind, std::size_t index, std::int32_t value) {
  last_ = std::max(last_, t);
  events_[(oldest_ + waiting_) % events_.size()] = {last_, kind, static_cast<std::uint8_t>(index),
                                                    value};
  ++waiting_;
}

} // namespace octascope::hal::linux_backend
