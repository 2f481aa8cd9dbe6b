// The keys shared by reports and `octascope status`.
#pragma once

#include <cmath>

#include <nlohmann/json.hpp>

#include "firmware-host/supervision/run_counters.h"

namespace octascope::firmware_host {

using ReportJson = nlohmann::ordered_json;

// Three digits after the point: a microsecond of a millisecond. More would be noise.
inline double rounded(double value) {
  return std::round(value * 1000.0) / 1000.0;
}

inline ReportJson to_json(const pipeline::DurationSummary& s) {
  return {{"p50", rounded(s.p50_ms)},
          {"p95", rounded(s.p95_ms)},
          {"p99", rounded(s.p99_ms)},
          {"max", rounded(s.max_ms)}};
}

inline ReportJson to_json(const RunRates& rates) {
  return {{"lines_per_s", rounded(rates.lines_per_s)},
          {"volumes_per_s", rounded(rates.volumes_per_s)},
          {"shown_volumes_per_s", rounded(rates.shown_volumes_per_s)},
          {"frames_per_s", rounded(rates.frames_per_s)}};
}

inline ReportJson lost_to_json(const RunCounters& counters) {
  return {{"lines", counters.volumes.lost_lines},
          {"b_scans", counters.volumes.lost_b_scans},
          {"volumes", counters.volumes.lost_volumes}};
}

} // namespace octascope::firmware_host
