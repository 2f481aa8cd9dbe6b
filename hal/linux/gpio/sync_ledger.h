// Did the scanner answer each trigger pulse? Compares the sync line's rising edges with the pulses.
//
// Every pulse is to bring `expected` edges before the next pulse. Pure logic over times, one
// thread; pulses and edges are told in any order, each kind with times that never decrease, all
// edges up to a pulse before the pulse itself.
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
    if (!pulse_) { // of a sweep that nobody here started
      ++unexpected_;
      return;
    }
    if (++since_pulse_ > expected_)
      ++unexpected_;
    if (since_pulse_ == 1)
      delay_ = t - *pulse_;
  }

  // The pulse before a pause is not asked about any more.
  void forget_pulse() {
    pulse_.reset();
    since_pulse_ = 0;
  }

  std::uint64_t edges() const { return edges_; }
  // That should have come for a pulse and did not; told at the next pulse.
  std::uint64_t missed() const { return missed_; }
  // More than expected: noise on the line, or a second source.
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
