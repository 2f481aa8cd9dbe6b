// One line a second on a terminal while the appliance runs.
#pragma once

#include "firmware-host/supervision/run_counters.h"
#include "hal/clock.h"
#include "ui/status/status.h"

namespace octascope::firmware_host {

// Silent where stderr is not a terminal. One thread.
class StatusLine {
public:
  explicit StatusLine(hal::TimePoint started);

  // Whether a second has passed since the last line.
  bool due(hal::TimePoint now) const { return terminal_ && now >= next_; }
  void print(const ui::Status& shown, const RunCounters& counters);

  // Ends the line, so that further output starts on a fresh one.
  void finish();

private:
  hal::TimePoint started_;
  hal::TimePoint next_;
  bool terminal_;
  bool printed_ = false;
};

} // namespace octascope::firmware_host
