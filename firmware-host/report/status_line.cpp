#include "firmware-host/report/status_line.h"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

#include "firmware-host/terminal/terminal.h"

namespace octascope::firmware_host {

StatusLine::StatusLine(hal::TimePoint started)
    : started_(started), next_(started), terminal_(isatty(STDERR_FILENO) == 1) {}

void StatusLine::print(const ui::Status& shown, const RunCounters& c) {
  next_ = shown.now + std::chrono::seconds{1};
  show_progress(fmt::format(
      "{:6.0f} s  {:.1f} volumes/s  {:.0f} frames/s  latency {:.0f} ms  lost {} lines, {} B-scans, "
      "{} volumes{}{}",
      hal::to_seconds(shown.now - started_), c.rates.volumes_per_s, c.rates.frames_per_s,
      c.latency.p50_ms, c.volumes.lost_lines, c.volumes.lost_b_scans, c.volumes.lost_volumes,
      shown.replay ? "  REPLAY" : "", shown.simulated ? "  SIMULATED" : ""));
  printed_ = true;
}

void StatusLine::finish() {
  if (printed_)
    warn("\n");
}

} // namespace octascope::firmware_host
