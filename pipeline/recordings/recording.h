// What a recording holds: facts that are the same for all of it, and one entry for each volume.
//
// docs/RECORDINGS.md describes the file (HDF5), for those who read it with other programs.
#pragma once

#include <cstdint>
#include <string>

#include "pipeline/volume/eye.h"
#include "pipeline/volume/volume.h"

namespace octascope::pipeline {

struct RecordingFacts {
  VolumeGeometry geometry;
  double volume_period_s = 0; // planned, from trigger to trigger
  std::string recorded_by;    // program and version
  std::string begun;          // local time with its offset, ISO 8601: 2026-11-22T12:10:03+01:00
  std::string source;         // as the screen names it: "phantom eye, loop of 2.3 s"
  bool simulated = false;     // some of it is not the patient's
  std::string subject;        // as the user said for this recording; empty: not said
  Eye eye = Eye::not_said;
  std::string configuration; // the text in use
};

// The history of a volume as it is kept. Times are nanoseconds: of the monotonic clock that stamped
// the lines, and, for people, of the wall clock when the volume was ready (since 1970, UTC).
struct RecordedVolume {
  std::uint64_t index = 0; // VolumeMetadata::index: a gap is a volume that was lost or not kept
  std::int64_t first_line_ns = 0;
  std::int64_t last_line_ns = 0;
  std::int64_t published_ns = 0;
  std::int64_t wall_clock_ns = 0;
  std::int32_t lost_b_scans = 0;
  std::int32_t lost_lines = 0;
  std::int32_t saturated_lines = 0;
  double scan_lag_a_scans = 0;

  bool operator==(const RecordedVolume&) const = default;
};

RecordedVolume entry_of(const VolumeMetadata& metadata, std::int64_t wall_clock_ns);

// How it ended.
struct RecordingEnd {
  bool finished = false;      // else power or program was lost; what is there is whole
  std::uint64_t not_kept = 0; // volumes that came while it ran and that the disk was too slow for
};

} // namespace octascope::pipeline
