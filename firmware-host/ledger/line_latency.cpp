#include "firmware-host/ledger/line_latency.h"

#include <utility>

namespace octascope::firmware_host {

namespace {

constexpr int lines_counted = 16; // of a B-scan

} // namespace

void LineLatency::show(const pipeline::Volume& volume, const pipeline::BScanRange& b_scans) {
  if (volume.work.size() != shown_.size())
    return;
  for (auto b = static_cast<std::size_t>(b_scans.from); b < static_cast<std::size_t>(b_scans.to);
       ++b) {
    Shown& shown = shown_[b];
    if (!has_levels(volume.b_scan_states[b])) {
      shown.waits = false;
      continue;
    }
    const pipeline::BScanWork& work = volume.work[b];
    if (work.last_line <= shown.last_line)
      continue;
    shown = {work.first_line, work.last_line, true};
  }
}

void LineLatency::flipped(hal::TimePoint when) {
  for (Shown& shown : shown_) {
    if (!std::exchange(shown.waits, false))
      continue;
    const hal::Duration length = shown.last_line - shown.first_line;
    for (int line = 0; line < lines_counted; ++line) // in the middle of a sixteenth each
      latency_.add(when - (shown.first_line + length * (2 * line + 1) / (2 * lines_counted)));
  }
}

void LineLatency::forget() {
  for (Shown& shown : shown_)
    shown.waits = false;
}

} // namespace octascope::firmware_host
