// Lets the renderer draw a whole volume before the workers begin the next one's B-scans.
//
// Workers have real-time priority and take every core as soon as a frame comes. Right after a volume
// that hurts most: somebody waits for its picture, and nobody yet for the next one, whose last line is
// a whole volume away. Frames wait in the camera's buffers meanwhile.
#pragma once

#include <atomic>

#include "hal/clock.h"

namespace octascope::pipeline {

// Neither side ever waits for the other. Wait-free.
class RightOfWay {
public:
  // Renderer. Whether it wants it for each volume that is published from now on.
  void want(bool wanted) { wanted_.store(wanted, std::memory_order_relaxed); }
  bool is_wanted() const { return wanted_.load(std::memory_order_relaxed); }
  // Renderer. The volume is drawn; what is left is to wait for the refresh.
  void give_up() { until_.store(hal::TimePoint::min(), std::memory_order_relaxed); }

  // Who publishes. The renderer has it until then, if it wants it.
  void grant(hal::TimePoint until) {
    if (is_wanted())
      until_.store(until, std::memory_order_relaxed);
  }
  hal::TimePoint until() const { return until_.load(std::memory_order_relaxed); }

  // Who publishes. The workers get what had been held back since then. With half of their time to
  // spare they need as long once more to catch up.
  void hand_over(hal::TimePoint held_since, hal::TimePoint now) {
    caught_up_.store(now + (now - held_since), std::memory_order_relaxed);
  }
  // Workers. When they will have, or had.
  hal::TimePoint caught_up() const { return caught_up_.load(std::memory_order_relaxed); }

private:
  std::atomic<bool> wanted_{false};
  std::atomic<hal::TimePoint> until_{hal::TimePoint::min()};
  std::atomic<hal::TimePoint> caught_up_{hal::TimePoint::min()};
};

} // namespace octascope::pipeline
