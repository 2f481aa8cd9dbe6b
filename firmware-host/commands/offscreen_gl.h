// GL without a screen, for commands that draw pictures or measure drawing.
#pragma once

#include <memory>

#include "hal/linux/monotonic_clock.h"
#include "hal/result.h"
#include "sim/devices/offscreen_display.h"

namespace octascope::firmware_host {

// Keeps a context current on the opening thread while it lives. None may be current before, and all
// GL objects must be destroyed first.
class OffscreenGl {
public:
  // Binds a framebuffer of that size. Errors: OffscreenDisplay's.
  static hal::Result<std::unique_ptr<OffscreenGl>> open(int width, int height);

  hal::Clock& clock() { return clock_; }

private:
  OffscreenGl() = default;

  hal::linux_backend::MonotonicClock clock_;
  sim::OffscreenDisplay display_{clock_};
};

} // namespace octascope::firmware_host
