// Keys for a display on the console, where no window system delivers them.
#pragma once

#include <cstddef>
#include <span>

#include "hal/display.h"

namespace octascope::hal {

// Threads: one at a time (the render thread).
class KeySource {
public:
  virtual ~KeySource() = default;

  // Whether keys belong to this display: true while it is open and its console is in front. On
  // false, held keys are reported as released, and keys go to other programs from then on.
  void attend(bool ours) { do_attend(ours); }

  // As Display::poll_events(): never waits.
  std::size_t poll_events(std::span<DisplayEvent> events) { return do_poll_events(events); }

private:
  virtual void do_attend(bool ours) = 0;
  virtual std::size_t do_poll_events(std::span<DisplayEvent> events) = 0;
};

} // namespace octascope::hal
