// Proof that a thread is alive: it writes the time of each step, and a watcher reads it.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "hal/clock.h"

namespace octascope::pipeline {

// Written by one thread, read by any. A beat is one relaxed store, allowed in hot paths.
class Heartbeat {
public:
  // Call after each step while another one is due.
  void beat(hal::TimePoint now) {
    last_ns_.store(now.time_since_epoch().count(), std::memory_order_relaxed);
  }
  // Call before waiting for work without a limit, and at the thread's end.
  void rest() { last_ns_.store(resting, std::memory_order_relaxed); }

  // The time of the last step; empty while the thread rests.
  std::optional<hal::TimePoint> last() const {
    const std::int64_t ns = last_ns_.load(std::memory_order_relaxed);
    return ns == resting ? std::nullopt : std::optional{hal::TimePoint{hal::Duration{ns}}};
  }

  // The calling thread's own: given to it by its ThreadSetup, like its name and its priority. Until
  // then, and where nobody watches, a beat is lost.
  static void give_this_thread(Heartbeat* heartbeat) { own() = heartbeat; }
  static void beat_here(hal::TimePoint now) {
    if (Heartbeat* const heartbeat = own())
      heartbeat->beat(now);
  }
  static void rest_here() {
    if (Heartbeat* const heartbeat = own())
      heartbeat->rest();
  }

private:
  static constexpr std::int64_t resting = -1;

  static Heartbeat*& own() {
    thread_local constinit Heartbeat* value = nullptr;
    return value;
  }

  std::atomic<std::int64_t> last_ns_{resting};
};

} // namespace octascope::pipeline
