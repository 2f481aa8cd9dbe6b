// The scanner's beam position on the tissue while the camera reads a line.
#pragma once

#include "pipeline/scan/scan_plan.h"

namespace octascope::sim {

struct BeamPlace {
  float x_mm = 0; // from the centre of the scan field
  float y_mm = 0;
};

// A one-directional sweep moves evenly from the first A-scan to the last and returns along half a
// cosine. Bidirectional sweeps move evenly in both directions; in the turn-around lines the command
// overshoots, slows down, stops and returns along a parabola that continues both speeds. The
// mirrors follow the command with a delay of `lag_lines`, so the picture of a backward sweep is
// shifted against that of a forward one by twice that. (One-directional, a lag would only delay
// everything; acquisition is assumed to start with the mirror.)
class BeamPath {
public:
  BeamPath(const pipeline::ScanPlan& plan, double lag_lines)
      : plan_(plan), lag_lines_(plan.bidirectional ? lag_lines : 0) {}

  // `sweep` within a volume, `line` within its frame, both from 0.
  BeamPlace at(int sweep, int line) const;
  // The same in A-scans: 0 is the first, a_scans − 1 the last.
  double a_scan_at(int sweep, int line) const;

  double lag_lines() const { return lag_lines_; }

private:
  double there_and_back(double lines_since_start) const;

  pipeline::ScanPlan plan_;
  double lag_lines_;
};

} // namespace octascope::sim
