// The history of one volume, from the trigger to the display, and its losses.
#pragma once

#include <cstdint>
#include <optional>

#include "hal/clock.h"
#include "pipeline/volume/upper_border.h"

namespace octascope::pipeline {

struct VolumeMetadata {
  // Counts the planned volumes, from 1, also those that were never triggered: a gap is what was lost.
  // 0: no volume yet.
  std::uint64_t index = 0;

  hal::TimePoint pulsed;     // rising edge of the trigger pulse
  hal::TimePoint first_line; // camera timestamps, of what came
  hal::TimePoint last_line;
  // Of the frame that was exposed last, on its way from thread to thread.
  hal::TimePoint fetched{}; // the camera thread had it
  hal::TimePoint placed{};  // the fixed-rate thread knew its B-scan
  hal::TimePoint built{};   // the last of all B-scans was made
  hal::TimePoint published; // when the renderer could take it

  hal::Duration reconstruct{}; // work of all workers, summed
  hal::Duration assemble{};    // neighbour averaging and bookkeeping

  // B-scans of which no sweep came in time and whole; kept lines of all sweeps that did not, also
  // of those whose B-scan has others.
  std::int32_t lost_b_scans = 0;
  std::int32_t lost_lines = 0;
  BorderCount upper_border{};       // A-scans whose tissue reaches it: what is above is folded
  std::int32_t saturated_lines = 0; // of all converted ones, turn-around included

  double scan_lag_a_scans = 0; // bidirectional: with which all its sweeps were placed

  // Of a volume that is replayed: when it was ready, on the wall clock (since 1970, UTC). It goes
  // with the volume, so that none can be taken for a live one. Empty: live.
  std::optional<std::int64_t> recorded_ns{};
};

} // namespace octascope::pipeline
