#include "pipeline/recordings/recording.h"

namespace octascope::pipeline {

RecordedVolume entry_of(const VolumeLedger& ledger, std::int64_t wall_clock_ns) {
  return {.index = ledger.index,
          .first_line_ns = ledger.first_line.time_since_epoch().count(),
          .last_line_ns = ledger.last_line.time_since_epoch().count(),
          .published_ns = ledger.published.time_since_epoch().count(),
          .wall_clock_ns = wall_clock_ns,
          .lost_b_scans = ledger.lost_b_scans,
          .lost_lines = ledger.lost_lines,
          .saturated_lines = ledger.saturated_lines,
          .phase_offset_a_scans = ledger.phase_offset_a_scans};
}

} // namespace octascope::pipeline
