// Notices threads that make no progress, and real-time threads that never wait.
#pragma once

#include <atomic>
#include <cstddef>
#include <list>
#include <mutex>
#include <string>
#include <vector>

#include "hal/clock.h"
#include "pipeline/faults/fault_log.h"
#include "pipeline/threads/heartbeat.h"
#include "pipeline/threads/worker_pool.h"

namespace octascope::firmware_host {

// Of a real-time thread whose steps wait; short enough for the program to be ended within a second.
inline constexpr hal::Duration longest_without_wait = std::chrono::milliseconds{700};

struct ThreadState {
  std::string name;        // "camera", "worker 1"
  bool stuck = false;      // no step for longer than its limit
  hal::Duration silence{}; // since its last step; 0 while none is due
};

// Thread-safe. Outlives the threads that it watches.
class ThreadWatch {
public:
  ThreadWatch() = default;
  ThreadWatch(const ThreadWatch&) = delete;
  ThreadWatch& operator=(const ThreadWatch&) = delete;

  // Gives the calling thread its heartbeat; its first step is due from `now` on. Nothing for roles
  // that need no watching: a thread that the render thread waits for is covered by the watchdog,
  // and one that works in the background for as long as it likes has no step that is due.
  void enlist(const pipeline::ThreadRole& role, hal::TimePoint now);

  std::vector<ThreadState> states(hal::TimePoint now) const;

  // Reports one fault per stuck thread, for the device or part that it serves, and one for each that
  // lost its real-time priority since the last call.
  void complain(pipeline::FaultLog& faults, hal::TimePoint now);

private:
  struct Watched {
    std::string name;
    pipeline::Fault when_stuck{};
    hal::Duration limit;
    pipeline::Heartbeat heartbeat;
    std::atomic<bool> demoted{false}; // hal/linux/realtime.h
  };

  mutable std::mutex mutex_;
  std::list<Watched> threads_; // in place: the heartbeats are in use
};

} // namespace octascope::firmware_host
