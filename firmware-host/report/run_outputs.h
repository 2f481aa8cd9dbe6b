// What a run writes besides its report.
#pragma once

#include <optional>

#include <fmt/format.h>

#include "firmware-host/configuration/run_options.h"
#include "firmware-host/ledger/trace.h"
#include "firmware-host/terminal/terminal.h"
#include "hal/result.h"
#include "pipeline/files/png_image.h"

namespace octascope::firmware_host {

// Checks before the run that outputs can be written; leaves nothing behind.
hal::Result<> check_outputs(const RunOptions& options);

// Prints a report, and writes it if requested.
template <class Report>
hal::Result<> leave_report(const Report& report, const RunOptions& options) {
  say("{}", to_text(report));
  if (!options.report)
    return {};
  HAL_CHECK(write_report(report, *options.report));
  say("report:   {}\n", options.report->string());
  return {};
}

// Writes the last picture if requested, and prints its path. `picture` is empty if the display was
// gone.
hal::Result<> leave_snapshot(const RunOptions& options,
                             const std::optional<pipeline::Image>& picture);

// Writes the trace that was requested, and prints its path.
hal::Result<> leave_trace(const Trace& trace, const RunOptions& options, hal::TimePoint started);

} // namespace octascope::firmware_host
