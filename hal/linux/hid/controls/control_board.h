// Combines the readings of all controls: numbers their switches and knobs, debounces, and returns
// the events in order of time.
//
// The leading device has the first numbers, so that its profile fits; the switches and knobs of the
// other devices follow, so a separate knob complements a pedal without one. Axes keep their
// numbers. Pure logic over explicit times, one thread; no allocation.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "hal/control_input.h"
#include "hal/linux/hid/decoders/hid_decoder.h"
#include "hal/linux/hid/models/control_model.h"
#include "hal/switch_debouncer.h"

namespace octascope::hal::linux_backend {

class ControlBoard {
public:
  static constexpr std::size_t most_devices = 8, most_ports = 16, most_knobs = 8;

  // The numbers of a device's switches and knobs.
  struct Place {
    int first_switch = 0, switches = 0;
    int first_knob = 0, knobs = 0;
  };

  // Removes all devices, but not the waiting events.
  void vacate();
  // Also removes the waiting events. Times still never decrease.
  void clear();

  // Returns the device's number; empty if the board is full. Switches and knobs beyond the limits
  // are ignored.
  std::optional<std::size_t> add_device(int switches, int knobs);
  // A device may have several ports (files): a switch is down if any of them reports it.
  std::optional<std::size_t> add_port(std::size_t device);
  Place place(std::size_t device) const { return devices_[device]; }

  // Call settle(now) first, and only while has_room(). Times must not decrease.
  void note(std::size_t port, const HidReading& reading, TimePoint now);
  void settle(TimePoint now);
  // Reports every pressed switch as released and every axis as centred.
  void release_all(TimePoint now);

  bool has_room() const { return waiting_ + most_at_once <= events_.size(); }
  // When settle() will report a change if nothing else happens.
  std::optional<TimePoint> due() const;
  // Takes the oldest events; returns their number.
  std::size_t take(std::span<ControlEvent> events);
  std::uint64_t bounces() const;

private:
  // The events of one note() and settle(), or of one release_all().
  static constexpr std::size_t most_at_once = most_switches + control_axes + 1;

  void report(TimePoint t, ControlKind kind, std::size_t index, std::int32_t value);

  struct Port {
    std::size_t device = 0;
    std::uint32_t down = 0;
  };

  std::array<Place, most_devices> devices_{};
  std::size_t device_count_ = 0;
  std::array<Port, most_ports> ports_{};
  std::size_t port_count_ = 0;
  int switches_ = 0, knobs_ = 0;

  std::array<SwitchDebouncer, most_switches> contacts_;
  std::array<std::int16_t, control_axes> axes_{};
  std::array<ControlEvent, 256> events_{}; // a ring
  std::size_t oldest_ = 0, waiting_ = 0;
  TimePoint last_{};
};

} // namespace octascope::hal::linux_backend
