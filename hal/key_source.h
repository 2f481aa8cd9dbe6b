// Key events for a display on the console, where there is no window system to deliver them.
#pragma once

#include <cstddef>
#include <span>

#include "hal/display.h"

namespace octascope::hal {

// Threads: one at a time (the render thread).
class KeySource {
public:
  virtual ~KeySource() = default;

  // Whether this display has the keyboard focus: true while it is open and its console is in the
  // foreground. On false, held keys are reported as released, and later keys go to other programs.
  void attend(bool ours) { do_attend(ours); }

  // Like Display::poll_events(): never waits.
  std::size_t poll_events(std::span<DisplayEvent> events) { return do_poll_events(events); }

private:
  virtual void do_attend(bool ours) = 0;
  virtual std::size_t do_poll_events(std::span<DisplayEvent> events) = 0;
};

} // namespace octascope::hal
