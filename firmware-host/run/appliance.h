// The composition root: every device, thread and picture of a running appliance is made here.
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
  // The Error's message is for the user. `crash_report` outlives the appliance.
  static hal::Result<std::unique_ptr<Appliance>> assemble(const RunOptions& options,
                                                          CrashReport& crash_report);
  virtual ~Appliance() = default;

  // Until the duration or the volumes are done, the display is closed, or a stop is requested.
  // Then writes snapshot and report, and prints the summary.
  virtual hal::Result<> run(StopSignal& stop_signal) = 0;
};

} // namespace octascope::firmware_host
