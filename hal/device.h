// The base class of all devices: backend name, whether it is simulated, and state.
#pragma once

#include <atomic>
#include <cstdint>
#include <string_view>

#include "hal/result.h"

namespace octascope::hal {

// absent --open--> ready --start--> streaming --stop--> ready --close--> absent
// Any state except absent can become `failed`; close() then returns to absent, and open() may be
// tried again. A device without a stream (trigger, control input, display) operates in `ready`.
enum class DeviceState : std::uint8_t { absent, ready, streaming, failed };

std::string_view to_string(DeviceState state);

class Device {
public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device() = default;

  // Thread-safe.
  DeviceState state() const { return state_.load(std::memory_order_acquire); }

  // The implementation ("v4l2", "sim", "offscreen" …): a string literal.
  std::string_view backend() const { return do_backend(); }

  // True for a simulated device: its data are not the patient's, and the display says so.
  bool simulated() const { return do_simulated(); }

protected:
  // Public methods call this first, so that a call in the wrong state is the same error for every
  // device: ErrorCode::disconnected if it has failed and must be closed, else
  // ErrorCode::invalid_argument. `kind` and `call` are for the message.
  Result<> in_order(std::string_view kind, std::string_view call, DeviceState expected) const {
    return state() == expected ? Result<>{} : out_of_order(kind, call, expected);
  }
  void set_state(DeviceState state) { state_.store(state, std::memory_order_release); }

private:
  Result<> out_of_order(std::string_view kind, std::string_view call, DeviceState expected) const;

  virtual std::string_view do_backend() const = 0;
  virtual bool do_simulated() const = 0;

  std::atomic<DeviceState> state_{DeviceState::absent};
};

} // namespace octascope::hal
