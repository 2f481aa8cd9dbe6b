// The composition root of a replay: display, pedal and knob, and volumes from a recording.
#pragma once

#include <memory>

#include "firmware-host/configuration/run_options.h"
#include "hal/result.h"

namespace octascope::firmware_host {

class StopSignal;

// Bound to the thread that makes it; that thread becomes the render thread.
class Replay {
public:
  // `options.replay` is set. Opens the recording and reads every file that the options name; starts
  // nothing, writes nothing. The Error's message is for the user; what another command line would
  // fix is ErrorCode::invalid_argument.
  static hal::Result<std::unique_ptr<Replay>> assemble(const RunOptions& options);
  virtual ~Replay() = default;

  // Until the duration, the volumes or the recording are done, the display is closed, or a stop is
  // requested. Then writes snapshot and report, and prints the summary. ErrorCode::bad_data: none
  // of the volumes could be read any more.
  virtual hal::Result<> run(StopSignal& stop_signal) = 0;
};

} // namespace octascope::firmware_host
