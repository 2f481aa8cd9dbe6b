// What the reports of runs and of replays have in common.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "hal/clock.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/threads/duration_statistics.h"

namespace octascope::firmware_host {

using ReportJson = nlohmann::ordered_json;

// Three digits after the point are a microsecond of a millisecond: more would be noise.
inline double rounded(double value) {
  return std::round(value * 1000.0) / 1000.0;
}

inline ReportJson to_json(const pipeline::DurationSummary& s) {
  return {{"p50", rounded(s.p50_ms)}, {"p95", rounded(s.p95_ms)}, {"max", rounded(s.max_ms)}};
}

// Their times are relative to `started`.
inline ReportJson to_json(const std::vector<pipeline::FaultRecord>& faults,
                          hal::TimePoint started) {
  ReportJson json = ReportJson::array();
  for (const pipeline::FaultRecord& f : faults)
    json.push_back({{"device", facts_of(f.kind).device_key()},
                    {"kind", facts_of(f.kind).key},
                    {"message", f.message},
                    {"count", f.count},
                    {"first_s", rounded(hal::to_seconds(f.first - started))},
                    {"last_s", rounded(hal::to_seconds(f.last - started))}});
  return json;
}

// A line a fault.
inline std::string to_text(const std::vector<pipeline::FaultRecord>& faults) {
  std::string text;
  for (const pipeline::FaultRecord& f : faults)
    text += fmt::format("fault: {} {} ×{}: {}\n", facts_of(f.kind).device_key(),
                        facts_of(f.kind).key, f.count, f.message);
  return text;
}

} // namespace octascope::firmware_host
