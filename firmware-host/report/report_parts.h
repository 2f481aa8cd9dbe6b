// Parts shared by the reports of runs and replays.
#pragma once

#include <string>
#include <vector>

#include <fmt/format.h>

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

// A line a fault.
inline std::string to_text(const std::vector<pipeline::FaultRecord>& faults) {
  std::string text;
  for (const pipeline::FaultRecord& f : faults)
    text += fmt::format("fault: {} {} ×{}: {}\n", facts_of(f.kind).device_key(),
                        facts_of(f.kind).key, f.count, f.message);
  return text;
}

} // namespace octascope::firmware_host
