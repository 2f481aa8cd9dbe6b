// One calm line a second on a terminal while the appliance runs.
#pragma once

#include "hal/clock.h"
#include "ui/status/status.h"

namespace octascope::firmware_host {

// Silent where stderr is not a terminal. One thread.
class StatusLine {
public:
  explicit StatusLine(hal::TimePoint started);

  // Prints when a second has passed since the last line.
  void update(const ui::Status& status);

  // Leaves the line, so that what follows starts on a fresh one.
  void finish();

private:
  hal::TimePoint started_;
  hal::TimePoint next_;
  bool terminal_;
  bool printed_ = false;
};

} // namespace octascope::firmware_host
