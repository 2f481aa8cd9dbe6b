// Ends long pulses asynchronously, on a thread that sleeps until the pulse is over.
#pragma once

#include <functional>
#include <thread>

#include "hal/clock.h"
#include "hal/linux/system/file_descriptor.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

// Threads: one thread at a time. `end` runs on the timer's own thread, which inherits the
// scheduling of the thread that called start().
class PulseTimer {
public:
  ~PulseTimer() { stop(); }

  Result<> start(std::function<void()> end);

  // Has `end` called once at `time` (CLOCK_MONOTONIC), replacing an earlier request. Returns 0 or
  // errno. One system call, no allocation, no lock.
  int end_at(TimePoint time) noexcept;

  // After it returns, `end` is not running and will not run.
  void stop();

private:
  void run(const std::function<void()>& end);

  FileDescriptor timer_, stopping_;
  std::thread thread_;
};

} // namespace octascope::hal::linux_backend
