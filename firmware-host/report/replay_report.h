// The report of a replay. Its keys are a contract: tools read them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "firmware-host/ledger/shown_quality.h"
#include "firmware-host/supervision/run_counters.h"
#include "hal/clock.h"
#include "hal/result.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/recordings/recording.h"

namespace octascope::firmware_host {

struct ReplayReport {
  std::filesystem::path file;
  pipeline::RecordingFacts facts;
  pipeline::RecordingEnd end;
  std::size_t recorded = 0;           // volumes in the file
  std::string control_input, display; // backends
  RunCounters counters;
  QualitySummary quality; // of the shown frames
  double duration_s = 0;
  std::vector<pipeline::FaultRecord> faults;
  hal::TimePoint started; // fault times are relative to it
};

// One JSON object, indented.
std::string to_json(const ReplayReport& report);

// The same for a person: a few lines.
std::string to_text(const ReplayReport& report);

// Whole or not at all.
hal::Result<> write_report(const ReplayReport& report, const std::filesystem::path& file);

} // namespace octascope::firmware_host
