// What every device has in common: backend, whether it is simulated, and a state for any thread to
// read.
#pragma once

#include <atomic>
#include <cstdint>
#include <string_view>

namespace octascope::hal {

// absent --open--> ready --start--> streaming --stop--> ready --close--> absent
// Any state but absent can become `failed`; close() leads from there back to absent, and open()
// may then be tried again. A device that has no stream (trigger, control input, display) works in
// the state `ready`.
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

  // Which implementation this is ("v4l2", "sim", "offscreen" …): a literal, valid for ever.
  std::string_view backend() const { return do_backend(); }

  // True for a twin: what it delivers is not the patient's. The display says so.
  bool simulated() const { return do_simulated(); }

protected:
  void set_state(DeviceState state) { state_.store(state, std::memory_order_release); }

private:
  virtual std::string_view do_backend() const = 0;
  virtual bool do_simulated() const = 0;

  std::atomic<DeviceState> state_{DeviceState::absent};
};

} // namespace octascope::hal
