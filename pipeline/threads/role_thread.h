// A thread with a role, which goes on until it is told to stop.
#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string_view>
#include <thread>
#include <utility>

#include "pipeline/threads/heartbeat.h"
#include "pipeline/threads/wakeup.h"

namespace octascope::pipeline {

struct ThreadRole {
  std::string_view name;
  std::size_t number = 0; // of a worker, from 0
};

// Called first thing on each new thread, with the thread's role: sets name, priority and core. The
// pipeline knows no operating-system backend, so the composition root brings this.
using ThreadSetup = std::function<void(ThreadRole role)>;

// Bound to one thread, except stopping(). Whoever has one declares it last: its end, which waits
// for the thread, then comes before that of what the thread uses.
class RoleThread {
public:
  // `wakeup`, which the thread waits for, is posted by stop(). It outlives this.
  explicit RoleThread(Wakeup* wakeup = nullptr) : wakeup_{wakeup} {}
  ~RoleThread() { stop(); }
  RoleThread(const RoleThread&) = delete;
  RoleThread& operator=(const RoleThread&) = delete;

  // Once. `run` returns soon after stopping() has become true.
  template <class Run> void start(ThreadRole role, const ThreadSetup& setup, Run run) {
    thread_ = std::thread{[role, setup, run = std::move(run)] {
      if (setup)
        setup(role);
      run();
      Heartbeat::rest_here();
    }};
  }
  // Waits for its end. Nothing happens without a start().
  void stop() {
    if (!started())
      return;
    stopping_.store(true, std::memory_order_release);
    if (wakeup_ != nullptr)
      wakeup_->post();
    thread_.join();
  }

  // Between start() and stop().
  bool started() const { return thread_.joinable(); }
  // Any thread.
  bool stopping() const { return stopping_.load(std::memory_order_acquire); }

private:
  Wakeup* wakeup_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

} // namespace octascope::pipeline
