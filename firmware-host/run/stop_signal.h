// SIGINT and SIGTERM, polled without a signal handler.
#pragma once

namespace octascope::firmware_host {

// Make it before any thread starts: the signals are then blocked in all threads and queued on a
// descriptor. One thread asks. A second signal after the first was seen ends the program at once.
class StopSignal {
public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  // Never blocks. True from the first signal on.
  bool requested();

private:
  int descriptor_ = -1;
  bool requested_ = false;
};

} // namespace octascope::firmware_host
