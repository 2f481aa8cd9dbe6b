// Where on the tissue the scanner's mirrors point while the camera reads a line.
#pragma once

#include "pipeline/scan/scan_plan.h"

namespace octascope::sim {

struct BeamPlace {
  float x_mm = 0; // from the centre of the scan field
  float y_mm = 0;
};

// One-directional sweeps go evenly from the first A-scan to the last, and half a cosine swings the
// beam back. Bidirectional ones go evenly there and back; in the turn-around lines the command
// overshoots, slows down, stops and comes back as a parabola that continues both speeds. The
// mirrors lag the command by `lag_lines`: a backward sweep's picture is shifted by twice that
// against a forward one's. (One-directional, a lag would only delay everything, and acquisition is
// taken to start with the mirror.)
class BeamPath {
public:
  BeamPath(const pipeline::ScanPlan& plan, double lag_lines)
      : plan_(plan), lag_lines_(plan.bidirectional ? lag_lines : 0) {}

  // `sweep` of a volume, `line` of its frame, both from 0.
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
