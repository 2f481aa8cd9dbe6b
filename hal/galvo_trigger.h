// The galvo trigger: one pulse starts the sweeps of one volume.
//
// User-space toggling jitters by tens of microseconds, a line lasts 4.65 µs: so the trigger starts
// volumes and never clocks lines. A pulse that comes while the sweeps of the last one still run is
// latched by the scanner, one deep, and starts right behind them; a second one is lost.
#pragma once

#include "hal/clock.h"
#include "hal/device.h"
#include "hal/result.h"

namespace octascope::hal {

struct GalvoTriggerConfig {
  Duration pulse_width = std::chrono::microseconds{50}; // > 0
};

// Threads: one thread at a time (the fixed-rate thread). state() is free.
class GalvoTrigger : public Device {
public:
  // absent → ready; the line is held exclusively and at its safe (low) level.
  Result<> open(const GalvoTriggerConfig& config) { return do_open(config); }

  // Makes one pulse and returns when its rising edge was made. Neither allocates nor locks when it
  // succeeds. ErrorCode::disconnected: the line is gone, the state is `failed`; close() and open().
  Result<TimePoint> arm() { return do_arm(); }

  // Back to the safe level; any state → absent.
  void close() { do_close(); }

private:
  virtual Result<> do_open(const GalvoTriggerConfig& config) = 0;
  virtual Result<TimePoint> do_arm() = 0;
  virtual void do_close() = 0;
};

} // namespace octascope::hal
