// Ends long pulses beside the caller: a thread that sleeps until the pulse is over.
#pragma once

#include <functional>
#include <thread>

#include "hal/clock.h"
#include "hal/linux/system/file_descriptor.h"
#include "hal/result.h"

namespace octascope::hal::linux_backend {

// Threads: one thread at a time. `end` runs on a thread of this, which has the scheduling of the
// one that called start().
class PulseTimer {
public:
  ~PulseTimer() { stop(); }

  Result<> start(std::function<void()> end);

  // Calls `end` once at `time` of CLOCK_MONOTONIC; an earlier wish is replaced. 0, or errno. One
  // system call, no allocation, no lock.
  int end_at(TimePoint time) noexcept;

  // When it returns, `end` does not run and will not.
  void stop();

private:
  void run(const std::function<void()>& end);

  FileDescriptor timer_, stopping_;
  std::thread thread_;
};

} // namespace octascope::hal::linux_backend
