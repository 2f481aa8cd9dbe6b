// Checks that the scanner answers each trigger pulse, by comparing the sync line's rising edges
// with the pulses.
//
// Each pulse must be followed by `expected` edges before the next pulse. Report all edges up to a
// pulse before the pulse itself; the times of pulses, and those of edges, must not decrease. Pure
// logic over times, for one thread.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "hal/clock.h"

namespace octascope::hal::linux_backend {

class SyncMonitor {
public:
  explicit SyncMonitor(std::uint64_t expected = 1) : expected_(expected) {}

  void pulse(TimePoint t) {
    settle();
    pulse_ = t;
  }

  void edge(TimePoint t) {
    ++edges_;
    if (!pulse_) { // from a sweep that this trigger did not start
      ++unexpected_;
      return;
    }
    if (++since_pulse_ > expected_)
      ++unexpected_;
    if (since_pulse_ == 1)
      delay_ = t - *pulse_;
  }

  // Before a pause: no more edges are expected for the last pulse.
  void forget_pulse() {
    pulse_.reset();
    since_pulse_ = 0;
  }

  std::uint64_t edges() const { return edges_; }
  // Expected edges that did not arrive; updated at the next pulse.
  std::uint64_t missed() const { return missed_; }
  // Edges beyond those expected: noise on the line, or a second source.
  std::uint64_t unexpected() const { return unexpected_; }
  // From the last answered pulse to its first edge.
  std::optional<Duration> delay() const { return delay_; }

private:
  void settle() {
    if (pulse_)
      missed_ += expected_ - std::min(expected_, since_pulse_);
    since_pulse_ = 0;
  }

  std::uint64_t expected_;
  std::optional<TimePoint> pulse_;
  std::uint64_t since_pulse_ = 0;
  std::uint64_t edges_ = 0, missed_ = 0, unexpected_ = 0;
  std::optional<Duration> delay_;
};

} // namespace octascope::hal::linux_backend
