// The composition root: every device, thread and picture of a run or a replay is made here.
#pragma once

#include <memory>

#include "firmware-host/configuration/run_options.h"
#include "hal/result.h"

namespace octascope::firmware_host {

class CrashReport;
class StopSignal;

// Bound to the thread that makes it; that thread becomes the render thread.
class Appliance {
public:
  // Reads every file that the options name and makes all devices; starts nothing, writes nothing.
  // Where the options name a replay, its recording takes the place of cameras and trigger. The
  // Error's message is for the user; what another command line would fix is
  // ErrorCode::invalid_argument. `crash_report` outlives the appliance; a replay needs none.
  static hal::Result<std::unique_ptr<Appliance>> assemble(const RunOptions& options,
                                                          CrashReport* crash_report);
  virtual ~Appliance() = default;

  // Until the duration, the volumes or the recording are done, the display is closed, or a stop is
  // requested. Then writes snapshot and report, and prints the summary. ErrorCode::bad_data: none
  // of a recording's volumes could be read any more.
  virtual hal::Result<> run(StopSignal& stop_signal) = 0;
};

} // namespace octascope::firmware_host
