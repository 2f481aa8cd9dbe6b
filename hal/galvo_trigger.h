// The galvo trigger: one pulse starts the sweeps of one volume.
//
// User-space toggling jitters by tens of microseconds and a line lasts 4.65 µs, so the trigger
// starts volumes and never clocks lines. While sweeps are running, the scanner latches one further
// pulse and starts its sweeps right after them; any more are lost.
#pragma once

#include "hal/clock.h"
#include "hal/device.h"
#include "hal/result.h"

namespace octascope::hal {

struct GalvoTriggerConfig {
  Duration pulse_width = std::chrono::microseconds{50}; // > 0
};

// Threads: one thread at a time (the fixed-rate thread). state() may be called from any thread.
class GalvoTrigger : public Device {
public:
  // absent → ready; holds the line exclusively, at its safe (low) level.
  Result<> open(const GalvoTriggerConfig& config) {
    HAL_CHECK(in_order(kind, "open", DeviceState::absent));
    if (config.pulse_width <= Duration{})
      return fail(ErrorCode::invalid_argument, "{} {}: pulse_width is {} ns, expected more than 0",
                  backend(), kind, config.pulse_width.count());
    return do_open(config);
  }

  // Makes one pulse and returns the time of its rising edge. Neither allocates nor locks when it
  // succeeds. ErrorCode::disconnected: the line is gone, the state is `failed`; close() and open().
  Result<TimePoint> pulse() {
    HAL_CHECK(in_order(kind, "pulse", DeviceState::ready));
    return do_pulse();
  }

  // Any state → absent; sets the safe level.
  void close() { do_close(); }

private:
  static constexpr std::string_view kind = "galvo trigger";

  virtual Result<> do_open(const GalvoTriggerConfig& config) = 0;
  virtual Result<TimePoint> do_pulse() = 0;
  virtual void do_close() = 0;
};

} // namespace octascope::hal
