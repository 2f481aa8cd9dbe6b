// Keys for a display that has none of its own: the console's, where no window system brings them.
#pragma once

#include <cstddef>
#include <span>

#include "hal/display.h"

namespace octascope::hal {

// Threads: one at a time (the render thread).
class KeySource {
public:
  virtual ~KeySource() = default;

  // Whether what is typed is meant for us: not before the display is open, and not while another
  // console is in front. From false on, keys that were held are told as released, and what is typed
  // is left to others.
  void attend(bool ours) { do_attend(ours); }

  // As Display::poll_events(): never waits.
  std::size_t poll_events(std::span<DisplayEvent> events) { return do_poll_events(events); }

private:
  virtual void do_attend(bool ours) = 0;
  virtual std::size_t do_poll_events(std::span<DisplayEvent> events) = 0;
};

} // namespace octascope::hal
