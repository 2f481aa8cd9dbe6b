// The composition root: makes every device, thread and picture of a run or a replay.
#pragma once

#include <memory>

#include "firmware-host/configuration/run_options.h"
#include "hal/result.h"

namespace octascope::firmware_host {

class CrashReport;
class StopSignal;

// Bound to the thread that makes it, which becomes the render thread.
class Appliance {
public:
  // Reads every file that the options name and makes all devices; starts nothing, writes nothing.
  // For a replay, the recording replaces cameras and trigger. The Error's message is for the user;
  // ErrorCode::invalid_argument: another command line would fix it. `crash_report` must outlive the
  // appliance; a replay needs none.
  static hal::Result<std::unique_ptr<Appliance>> assemble(const RunOptions& options,
                                                          CrashReport* crash_report);
  virtual ~Appliance() = default;

  // Runs until the duration, the volumes or the recording end, the display is closed, or a stop is
  // requested. Then writes snapshot and report, and prints the summary. ErrorCode::bad_data: none
  // of a recording's volumes could be read any more.
  virtual hal::Result<> run(StopSignal& stop_signal) = 0;
};

} // namespace octascope::firmware_host
