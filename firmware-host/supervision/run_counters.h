// What a run or replay has counted so far, gathered in one place for display, status line, report,
// `octascope status` and metrics.
#pragma once

#include <cstdint>

#include "pipeline/acquisition/volume_feed.h"
#include "pipeline/threads/duration_statistics.h"

namespace octascope::firmware_host {

struct RunRates {
  double lines_per_s = 0;
  double volumes_per_s = 0;       // that came: acquired or passed over
  double shown_volumes_per_s = 0; // of those, in a frame that reached the glass
  double frames_per_s = 0;
};

// The books balance once the threads have ended (ARCHITECTURE.md, "What counts as lost"):
//   volumes.planned = volumes.acquired + volumes.passed_over + volumes.lost_volumes +
//                     volumes.unfinished
//   volumes.acquired = displayed + volumes.skipped + undisplayed
struct RunCounters {
  pipeline::VolumeCounters volumes;
  std::uint64_t displayed = 0;   // volumes in a frame that reached the glass
  std::uint64_t undisplayed = 0; // taken, and then the display failed: "lost" of the volumes
  std::uint64_t lines = 0;       // of all frames received, fly-back included
  std::uint64_t frames_drawn = 0, frames_missed = 0;
  std::uint64_t hot_path_allocations = 0;
  RunRates rates;                    // over the last two seconds; in a report, over the whole run
  pipeline::DurationSummary latency; // last line of a volume → first frame that shows it
};

} // namespace octascope::firmware_host
