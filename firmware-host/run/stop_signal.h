// SIGINT, SIGTERM and SIGHUP, polled without a signal handler.
#pragma once

#include <csignal>
#include <cstdint>

namespace octascope::firmware_host {

// SIGHUP says that the terminal went away. To a service it says that the configuration is to be
// read anew (configuration_watch.h).
enum class HangUp : std::uint8_t { ends, reloads };

// Make it before any thread starts: the signals are then blocked in all threads and queued on a
// descriptor. One thread asks. A second signal after the first was seen ends the program at once.
class StopSignal {
public:
  explicit StopSignal(HangUp hang_up = HangUp::ends);
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  // Never blocks. True from the first signal on.
  bool requested();

private:
  sigset_t signals_{};
  int descriptor_ = -1;
  bool requested_ = false;
};

} // namespace octascope::firmware_host
