#include "firmware-host/report/status_line.h"

#include <cstdio>

#include <fmt/format.h>
#include <unistd.h>

namespace octascope::firmware_host {

StatusLine::StatusLine(hal::TimePoint started)
    : started_(started), next_(started), terminal_(isatty(STDERR_FILENO) == 1) {}

void StatusLine::update(const ui::Status& s) {
  if (!terminal_ || s.now < next_)
    return;
  next_ = s.now + std::chrono::seconds{1};
  // \r and "erase to the end of the line": each second overwrites the one before.
  fmt::print(stderr,
             "\r{:6.0f} s  {:.1f} volumes/s  {:.0f} frames/s  latency {:.0f} ms  lost {} lines, {} "
             "B-scans, {} volumes{}{}\x1b[K",
             hal::to_seconds(s.now - started_), s.volumes_per_s, s.frames_per_s,
             s.latency_p50_ms.value_or(0), s.losses.lines, s.losses.b_scans, s.losses.volumes,
             s.replay ? "  REPLAY" : "", s.simulated ? "  SIMULATED" : "");
  std::fflush(stderr);
  printed_ = true;
}

void StatusLine::finish() {
  if (printed_)
    std::fputc('\n', stderr);
}

} // namespace octascope::firmware_host
