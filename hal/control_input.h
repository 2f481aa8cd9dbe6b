// The surgeon's input devices: pedals, knobs, 6-axis pucks.
//
// An event says what the device did, not what it means; ui/controls maps events to actions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "hal/clock.h"
#include "hal/device.h"
#include "hal/result.h"

namespace octascope::hal {

enum class ControlKind : std::uint8_t {
  pedal_switch, // value 1 pressed, 0 released; index 0 left, 1 centre, 2 right, …
  knob,         // value is the detents turned since the last event, clockwise is positive
  axis,         // value −1000…1000; index 0–2 translation x y z, 3–5 rotation x y z
};

struct ControlEvent {
  TimePoint time;
  ControlKind kind = ControlKind::pedal_switch;
  std::uint8_t index = 0;
  std::int32_t value = 0;
  bool operator==(const ControlEvent&) const = default;
};

// Threads: one thread at a time (the control thread). state() may be called from any thread.
class ControlInput : public Device {
public:
  // absent → ready.
  Result<> open() {
    HAL_CHECK(in_order(kind, "open", DeviceState::absent));
    return do_open();
  }

  // Waits at most `timeout` for events and writes up to events.size() of them, oldest first, with
  // times that never decrease. Returns their number, 0 if nothing happened. Contact bounce under
  // 5 ms is already removed. When a device disappears, every pressed switch is first reported as
  // released and every deflected axis as centred; then read() returns ErrorCode::disconnected and
  // the state is `failed`: call close() and open().
  Result<std::size_t> read(std::span<ControlEvent> events, Duration timeout) {
    HAL_CHECK(in_order(kind, "read", DeviceState::ready));
    return do_read(events, timeout);
  }

  // Bounces removed since construction; many indicate worn contacts. 0 if the device debounces
  // itself.
  std::uint64_t bounces() const { return do_bounces(); }

  // Any state → absent.
  void close() { do_close(); }

private:
  static constexpr std::string_view kind = "control input";

  virtual Result<> do_open() = 0;
  virtual Result<std::size_t> do_read(std::span<ControlEvent> events, Duration timeout) = 0;
  virtual std::uint64_t do_bounces() const { return 0; }
  virtual void do_close() = 0;
};

} // namespace octascope::hal
