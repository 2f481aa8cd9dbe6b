#include "firmware-host/report/run_outputs.h"

#include <filesystem>

#include "firmware-host/terminal/terminal.h"
#include "pipeline/files/atomic_file.h"

namespace octascope::firmware_host {

hal::Result<> check_outputs(const RunOptions& options) {
  for (const auto& file : {options.snapshot, options.report, options.trace}) {
    if (!file)
      continue;
    HAL_CHECK(pipeline::AtomicFile::create(*file));
  }
  return {};
}

hal::Result<> leave_snapshot(const RunOptions& options,
                             const std::optional<pipeline::Image>& picture) {
  if (!options.snapshot)
    return {};
  if (!picture)
    return hal::fail(hal::ErrorCode::absent, "{}: not written: the display was gone at the end",
                     options.snapshot->string());
  HAL_CHECK(pipeline::write_png(*options.snapshot, *picture));
  say("snapshot: {}\n", options.snapshot->string());
  return {};
}

hal::Result<> leave_trace(const Trace& trace, const RunOptions& options, hal::TimePoint started) {
  HAL_CHECK(trace.write(*options.trace, started));
  say("trace:    {}\n", options.trace->string());
  return {};
}

} // namespace octascope::firmware_host
