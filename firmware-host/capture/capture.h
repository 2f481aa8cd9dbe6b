// octascope capture: raw spectra to a file, without a display.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "firmware-host/configuration/run_options.h"
#include "hal/result.h"

namespace octascope::firmware_host {

class StopSignal;

struct CaptureOptions {
  RunOptions run;                     // of it: configuration, simulation, phantom, spectra, subject
  std::filesystem::path file;         // not there yet
  std::optional<std::uint64_t> lines; // kept ones: whole frames, until so many are there
  std::uint64_t volumes = 1;          // without `lines`
  bool average = false;               // one line, the mean of all kept ones, as f32
};

// Acquires until all are there or a stop is requested, and tells what the file holds. The Error's
// message is for the user; ErrorCode::invalid_argument: another command line would fix it;
// timed_out: nothing comes any more.
hal::Result<> capture(const CaptureOptions& options, StopSignal& stop_signal);

} // namespace octascope::firmware_host
