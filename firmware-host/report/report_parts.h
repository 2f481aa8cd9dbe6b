// Parts shared by the reports of runs, replays and benchmarks.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "firmware-host/ledger/shown_quality.h"
#include "firmware-host/supervision/counters_json.h"
#include "hal/clock.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/threads/duration_statistics.h"

namespace octascope::firmware_host {

// Times are relative to `started`.
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

// Null where the volume was not drawn, or has no steps.
inline ReportJson to_json(const QualitySummary& quality) {
  const auto range = [](const std::optional<QualityRange>& values) {
    return values
               ? ReportJson{{"median", rounded(values->median)}, {"worst", rounded(values->worst)}}
               : ReportJson{};
  };
  return {{"frames", quality.frames},
          {"resolution", range(quality.resolution)},
          {"steps", range(quality.steps)}};
}

// "resolution 0.70 (worst 0.50), steps 256 (192)"; empty where the volume was not drawn.
inline std::string to_text(const QualitySummary& quality) {
  std::string text;
  if (quality.resolution)
    text += fmt::format("resolution {:.2f} (worst {:.2f})", quality.resolution->median,
                        quality.resolution->worst);
  if (quality.steps)
    text += fmt::format(", steps {:.0f} ({:.0f})", quality.steps->median, quality.steps->worst);
  return text;
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
