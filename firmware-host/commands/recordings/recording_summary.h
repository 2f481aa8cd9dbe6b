// Statistics over the entries of a recording's volumes.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "pipeline/recordings/recording.h"

namespace octascope::firmware_host {

struct RecordingSummary {
  std::uint64_t volumes = 0;
  double duration_s = 0;         // from the first line of the first volume to the end of the last
                                 // volume
  std::optional<double> rate_hz; // of the volumes present; empty for fewer than two
  std::uint64_t first_index = 0; // as counted by the appliance
  std::uint64_t last_index = 0;
  std::uint64_t gaps = 0;            // places where volumes are missing between two others
  std::uint64_t volumes_in_gaps = 0; // number of missing volumes
  std::uint64_t longest_gap = 0;     // in volumes
  // Where the wall clock went on and the volumes' own clock did not: the machine slept, or its
  // clock was set. No volume was planned in that time.
  std::uint64_t pauses = 0;
  double paused_s = 0; // together
  std::int64_t lost_b_scans = 0;
  std::int64_t lost_lines = 0;
  std::int64_t saturated_lines = 0;
};

// `volume_period_s` is taken as the duration of the last volume.
RecordingSummary summarise(std::span<const pipeline::RecordedVolume> volumes,
                           double volume_period_s);

} // namespace octascope::firmware_host
