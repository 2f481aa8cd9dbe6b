// SIGINT and SIGTERM as something that can be asked, without a signal handler.
#pragma once

namespace octascope::firmware_host {

// Make it before any thread starts: the signals are blocked in all threads from then on and wait
// in a descriptor. One thread asks. A second signal after the first was seen ends the program at
// once, for those whose patience is over.
class StopSignal {
public:
  StopSignal();
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  // Never waits. True once a signal came, and ever after.
  bool requested();

private:
  int descriptor_ = -1;
  bool requested_ = false;
};

} // namespace octascope::firmware_host
