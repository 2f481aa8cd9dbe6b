// GL without a screen, for commands that draw pictures or measure how long that takes.
#pragma once

#include <memory>

#include "hal/linux/monotonic_clock.h"
#include "hal/result.h"
#include "sim/devices/offscreen_display.h"

namespace octascope::firmware_host {

// A context is current on the thread that opened it as long as this lives; none may be before, and
// GL's objects must be gone when it ends.
class OffscreenGl {
public:
  // With a framebuffer of that size bound. Faults: OffscreenDisplay's.
  static hal::Result<std::unique_ptr<OffscreenGl>> open(int width, int height);

  hal::Clock& clock() { return clock_; }

private:
  OffscreenGl() = default;

  hal::linux_backend::MonotonicClock clock_;
  sim::OffscreenDisplay display_{clock_};
};

} // namespace octascope::firmware_host
