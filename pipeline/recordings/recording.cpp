#include "pipeline/recordings/recording.h"

namespace octascope::pipeline {

RecordedVolume entry_of(const VolumeMetadata& metadata, std::int64_t wall_clock_ns) {
  return {.index = metadata.index,
          .first_line_ns = metadata.first_line.time_since_epoch().count(),
          .last_line_ns = metadata.last_line.time_since_epoch().count(),
          .published_ns = metadata.published.time_since_epoch().count(),
          .wall_clock_ns = wall_clock_ns,
          .lost_b_scans = metadata.lost_b_scans,
          .lost_lines = metadata.lost_lines,
          .saturated_lines = metadata.saturated_lines,
          .scan_lag_a_scans = metadata.scan_lag_a_scans};
}

} // namespace octascope::pipeline
