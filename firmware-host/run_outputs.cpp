#include "firmware-host/run_outputs.h"

#include <fmt/format.h>

#include "pipeline/atomic_file.h"

namespace octascope::firmware_host {

hal::Result<> check_outputs(const RunOptions& options) {
  for (const auto& file : {options.snapshot, options.report}) {
    if (!file)
      continue;
    if (const auto tried = pipeline::AtomicFile::create(*file); !tried)
      return tl::make_unexpected(tried.error());
  }
  if (options.snapshot && options.report &&
      options.snapshot->lexically_normal() == options.report->lexically_normal())
    return hal::fail(hal::Fault::invalid_argument,
                     fmt::format("--snapshot and --report are both {}, expected two files",
                                 options.report->string()));
  return {};
}

hal::Result<> leave_snapshot(const RunOptions& options,
                             const std::optional<pipeline::Image>& picture) {
  if (!options.snapshot)
    return {};
  if (!picture)
    return hal::fail(hal::Fault::absent,
                     fmt::format("{}: not written: the display was gone at the end",
                                 options.snapshot->string()));
  if (auto written = pipeline::write_png(*options.snapshot, *picture); !written)
    return written;
  fmt::print("snapshot: {}\n", options.snapshot->string());
  return {};
}

} // namespace octascope::firmware_host
