#include "pipeline/recordings/recording.h"

namespace octascope::pipeline {

std::string_view to_string(Eye eye) {
  switch (eye) {
  case Eye::left: return "left";
  case Eye::right: return "right";
  case Eye::not_said: break;
  }
  return "not said";
}

std::optional<Eye> eye_named(std::string_view word) {
  for (const Eye eye : {Eye::left, Eye::right}) {
    if (to_string(eye) == word)
      return eye;
  }
  return std::nullopt;
}

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
