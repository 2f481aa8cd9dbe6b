// From the exposure of every line to the glass.
#pragma once

#include <cstddef>
#include <vector>

#include "hal/clock.h"
#include "pipeline/threads/duration_statistics.h"
#include "pipeline/volume/volume.h"

namespace octascope::firmware_host {

// Of each line that is shown: from its exposure, by the camera's stamps, until the first frame that
// shows it was on the glass. Lines are exposed evenly: of a B-scan sixteen are counted, which stand
// for all. What a newer volume replaced before it was in a frame is not counted.
//
// For one thread. Allocates on construction only.
class LineLatency {
public:
  explicit LineLatency(int b_scans) : shown_(static_cast<std::size_t>(b_scans)) {}

  // These B-scans will be in the next frame, in the place of what was there. Those that have been in
  // one already are not counted again. A volume that is replayed has none.
  void show(const pipeline::Volume& volume, const pipeline::BScanRange& b_scans);

  // That frame is on the glass.
  void flipped(hal::TimePoint when);

  // It never will be: the display is gone.
  void forget();

  pipeline::DurationSummary summary() const { return latency_.summary(); }

private:
  struct Shown {
    hal::TimePoint first_line{}, last_line{}; // of what is or will be on the glass
    bool waits = false;                       // for the flip
  };
  std::vector<Shown> shown_; // by B-scan
  pipeline::DurationStatistics latency_;
};

} // namespace octascope::firmware_host
